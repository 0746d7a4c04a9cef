import { BufferAttribute, BufferGeometry, Color, Matrix4, Mesh, MeshStandardMaterial, Vector3 } from 'three';
import type { Mesh as MeshData } from '../run/protocol';
import type { Theme } from '../panel/theme';

const EXTENT = 40;

/** A half-space: a floor without end that fades into the background, with a grid of 1 m and of 10 cm. */
export class FloorView {
  readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly uniforms = {
    background: { value: new Color() },
    line: { value: new Color() },
    center: { value: new Vector3() },
    radius: { value: 1 },
  };

  /** `data` is a part of the plane; `center` and `radius` say where the scene is [m]. */
  constructor(data: MeshData, center: Vector3, radius: number) {
    const [a, b, c] = [0, 1, 2].map((k) => new Vector3().fromArray(data.vertices, 3 * data.triangles[k]));
    const normal = b.clone().sub(a).cross(c.clone().sub(a)).normalize();
    const upright = Math.abs(normal.y) > 0.5;
    const u = new Vector3(upright ? 1 : 0, upright ? 0 : 1, 0).projectOnPlane(normal).normalize();
    const v = normal.clone().cross(u);
    const origin = center.clone().projectOnPlane(normal).addScaledVector(normal, normal.dot(a));
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) =>
      origin.clone().addScaledVector(u, EXTENT * radius * x).addScaledVector(v, EXTENT * radius * y),
    );
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(corners.flatMap((corner) => corner.toArray())), 3));
    geometry.setAttribute('normal', new BufferAttribute(new Float32Array(corners.flatMap(() => normal.toArray())), 3));
    geometry.setAttribute('place', new BufferAttribute(new Float32Array(corners.flatMap((corner) => [corner.dot(u), corner.dot(v)])), 2));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.uniforms.center.value.copy(origin);
    this.uniforms.radius.value = radius;
    // Bodies that lie on the floor are in front of it.
    const material = new MeshStandardMaterial({ roughness: 1, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    material.onBeforeCompile = (shader) => this.draw(shader);
    this.mesh = new Mesh(geometry, material);
    this.mesh.receiveShadow = true;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.frustumCulled = false;
  }

  /** Places the floor as the half-space moves. */
  setMatrix(matrix: Matrix4): void {
    this.mesh.matrix.copy(matrix);
    this.mesh.matrixWorldNeedsUpdate = true;
  }

  update(visible: boolean, theme: Theme): void {
    this.mesh.visible = visible;
    this.mesh.material.color.copy(theme.floor);
    this.uniforms.background.value.copy(theme.background);
    this.uniforms.line.value.copy(theme.grid);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  /** The grid is drawn over the lit colour; lines that are too dense to be told apart fade. */
  private draw(shader: { vertexShader: string; fragmentShader: string; uniforms: Record<string, { value: unknown }> }): void {
    Object.assign(shader.uniforms, this.uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nattribute vec2 place;\nvarying vec2 vPlace;\nvarying vec3 vWhere;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvPlace = place;\nvWhere = position;');
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        `#include <common>
        varying vec2 vPlace;
        varying vec3 vWhere;
        uniform vec3 background;
        uniform vec3 line;
        uniform vec3 center;
        uniform float radius;
        float gridOf(float spacing, float width) {
          vec2 at = vPlace / spacing;
          vec2 pixel = fwidth(at);
          vec2 near = abs(fract(at - 0.5) - 0.5) / max(pixel, vec2(1e-6));
          vec2 strength = (1.0 - smoothstep(vec2(0.5 * width), vec2(0.5 * width + 1.0), near)) * (1.0 - smoothstep(0.08, 0.3, pixel));
          return max(strength.x, strength.y);
        }`,
      )
      .replace(
        '#include <opaque_fragment>',
        `float grid = max(0.34 * gridOf(1.0, 1.0), 0.15 * gridOf(0.1, 0.4));
        outgoingLight = mix(outgoingLight, outgoingLight * line, grid);
        #include <opaque_fragment>`,
      )
      .replace(
        '#include <dithering_fragment>',
        `float away = smoothstep(2.0, 8.0, distance(vWhere, center) / radius);
        gl_FragColor.rgb = mix(gl_FragColor.rgb, sRGBTransferOETF(vec4(background, 1.0)).rgb, away);
        #include <dithering_fragment>`,
      );
  }
}
