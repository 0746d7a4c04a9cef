import { Color, DoubleSide, MeshStandardMaterial } from 'three';
import type { SceneMessage } from '../run/protocol';

/** How a body looks. */
export interface Look { color: Color; roughness: number; sheen: number; shape: SurfaceShape }

/** A box has sharp edges, other solids are smooth; a cloth is seen from both sides. */
export type SurfaceShape = 'cloth' | 'box' | 'smooth';

/** Chosen to go together on light and dark ground, and to differ in lightness for colour-blind people. */
const PALETTE = ['#5b95d1', '#e3ad58', '#4fae93', '#d07a8c', '#9a90cf', '#8cc3dc', '#d98653', '#a4b55c'];

const PRESETS: Record<string, { color?: string; roughness: number; sheen: number }> = {
  cotton: { color: '#dcc9a8', roughness: 0.95, sheen: 0.25 },
  silk: { color: '#b8434f', roughness: 0.38, sheen: 0.5 },
  wool: { color: '#8d6f61', roughness: 1, sheen: 0.5 },
  denim: { color: '#3f5f8c', roughness: 0.95, sheen: 0.15 },
  jersey: { color: '#6f8f8a', roughness: 0.9, sheen: 0.3 },
  leather: { color: '#7a4a2e', roughness: 0.5, sheen: 0.05 },
  felt: { color: '#4f8464', roughness: 1, sheen: 0.6 },
  paper: { color: '#efece4', roughness: 0.85, sheen: 0 },
  rubber_sheet: { color: '#c9523f', roughness: 0.35, sheen: 0.1 },
  hemp: { color: '#b89a68', roughness: 0.95, sheen: 0.2 },
  nylon: { color: '#3f86c0', roughness: 0.5, sheen: 0.1 },
  steel_cable: { color: '#8d96a0', roughness: 0.35, sheen: 0 },
  hair: { color: '#5b4030', roughness: 0.5, sheen: 0.2 },
  soft_jelly: { color: '#d3566e', roughness: 0.22, sheen: 0.15 },
  firm_jelly: { color: '#5f9e4e', roughness: 0.25, sheen: 0.15 },
  foam: { color: '#e0c35a', roughness: 0.95, sheen: 0.1 },
  rubber_block: { color: '#4d555e', roughness: 0.4, sheen: 0.05 },
};
const CLOTH = { roughness: 0.9, sheen: 0.3 };
const SOLID = { roughness: 0.4, sheen: 0.08 };

/** plank_a and plank_b are of one kind, as rope_left and rope_right. */
function stem(name: string): string {
  return name.replace(/(\d+|[_-]([a-z]|left|right|east|west|north|south|front|back))$/i, '').replace(/[_-]$/, '');
}

/** The looks of the bodies of a scene. Bodies of one kind have one colour; a material has its own, for the first kind that is of it. */
export function looksOf(scene: SceneMessage): Look[] {
  const bodies = (scene.scene.bodies ?? {}) as Record<string, { material?: string; shape?: { type?: string } }>;
  const colors = new Map<string, Color>();
  const taken = new Set<string>();
  let next = 0;
  return scene.bodies.map(({ name }) => {
    const material = bodies[name]?.material ?? '';
    const preset = PRESETS[material];
    const type = bodies[name]?.shape?.type ?? '';
    const solid = type === 'solid' || type === 'lattice' || type === 'tetrahedra';
    const kind = stem(name);
    let color = colors.get(kind);
    if (!color) {
      const own = preset?.color && !taken.has(material) ? preset.color : PALETTE[next++ % PALETTE.length];
      taken.add(material);
      color = new Color(own);
      colors.set(kind, color);
    }
    const shape = type === 'solid' ? 'box' : solid ? 'smooth' : 'cloth';
    return { color, shape, ...(preset ? { roughness: preset.roughness, sheen: preset.sheen } : solid ? SOLID : CLOTH) };
  });
}

/** What the shader of a body's surface reads. */
export interface SurfaceUniforms {
  sheen: { value: number };
  /** The brightness of the inside. */
  inside: { value: number };
}

/**
 * The side of a cloth that is seen follows from the normal, not from the corners' order: along silhouettes and folds the faces that
 * just turn away would be lit from behind, as dark stitches.
 */
const NORMALS: Record<SurfaceShape, string> = {
  cloth: `float faceDirection = dot(normalize(vNormal), normalize(vViewPosition)) > -0.15 ? 1.0 : -1.0;
    vec3 normal = normalize(vNormal) * faceDirection;
    if (faceDirection < 0.0) diffuseColor.rgb *= inside;`,
  box: `float faceDirection = 1.0;
    vec3 normal = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));`,
  smooth: `float faceDirection = 1.0;
    vec3 normal = normalize(vNormal);`,
};

/** A surface that is lit by a sheen; a cloth has an inside of another tone. */
export function surfaceMaterial(shape: SurfaceShape, uniforms: SurfaceUniforms): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ vertexColors: true, side: DoubleSide });
  material.customProgramCacheKey = () => shape;
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', '#include <common>\nuniform float sheen;\nuniform float inside;')
      .replace(
        '#include <normal_fragment_begin>',
        `${NORMALS[shape]}
        vec3 nonPerturbedNormal = normal;`,
      )
      .replace(
        '#include <opaque_fragment>',
        `float rim = 1.0 - saturate(dot(normal, normalize(vViewPosition)));
        outgoingLight += sheen * rim * rim * rim * (0.25 + 0.75 * diffuseColor.rgb);
        #include <opaque_fragment>`,
      );
  };
  return material;
}
