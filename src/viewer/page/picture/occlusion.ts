import {
  CustomBlending,
  DepthTexture,
  DoubleSide,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  SrcColorFactor,
  WebGLRenderTarget,
  ZeroFactor,
} from 'three';
import type { PerspectiveCamera, WebGLRenderer } from 'three';
import type { Rect } from './scene_view';

/** The layer of what occludes: surfaces, but neither lines nor dots. */
export const SURFACES = 1;
/** The radius in which surfaces darken a point, relative to the scene's radius. */
const REACH = 0.09;

const vertexShader = 'varying vec2 uvAt; void main() { uvAt = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }';

const common = `
varying vec2 uvAt;
uniform sampler2D depth;
uniform mat4 unproject;
uniform vec2 pixel;
vec3 position_at(vec2 at) {
  vec4 p = unproject * vec4(2.0 * vec3(at, texture2D(depth, at).x) - 1.0, 1.0);
  return p.xyz / p.w;
}`;

/** Obscurance after McGuire et al., "The Alchemy Screen-Space Ambient Obscurance Algorithm" (2011), on a spiral that begins at another angle in each pixel. */
const shadeShader = `${common}
uniform float reach;
uniform float pixels;
vec3 shorter(vec3 a, vec3 b) { return dot(a, a) < dot(b, b) ? a : b; }
void main() {
  gl_FragColor = vec4(1.0);
  if (texture2D(depth, uvAt).x >= 1.0) return;
  vec3 p = position_at(uvAt);
  vec2 dx = vec2(pixel.x, 0.0);
  vec2 dy = vec2(0.0, pixel.y);
  vec3 n = normalize(cross(shorter(position_at(uvAt + dx) - p, p - position_at(uvAt - dx)), shorter(position_at(uvAt + dy) - p, p - position_at(uvAt - dy))));
  float angle0 = 6.2832 * fract(52.9829 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711, 0.005837))));
  float width = clamp(reach * pixels / -p.z, 4.0, 160.0);
  float sum = 0.0;
  for (float k = 0.5; k < 16.0; k += 1.0) {
    float angle = 2.39996 * k + angle0;
    vec3 v = position_at(uvAt + sqrt(k / 16.0) * width * pixel * vec2(cos(angle), sin(angle))) - p;
    float near = max(0.0, 1.0 - dot(v, v) / (reach * reach));
    sum += near * max(0.0, dot(v, n) / (length(v) + 1e-9) - 0.12);
  }
  gl_FragColor.rgb = vec3(max(0.0, 1.0 - sum / 10.0));
}`;

/** The mean of 4 x 4 pixels of the same surface, over which the first angles of the spirals repeat. */
const blurShader = `${common}
uniform sampler2D shade;
uniform float reach;
void main() {
  float depthHere = position_at(uvAt).z;
  float sum = 0.0;
  float weights = 0.0;
  for (float i = -1.5; i < 2.0; i += 1.0) {
    for (float j = -1.5; j < 2.0; j += 1.0) {
      vec2 at = uvAt + vec2(i, j) * pixel;
      float weight = 1e-4 + max(0.0, 1.0 - abs(position_at(at).z - depthHere) / (0.3 * reach));
      sum += weight * texture2D(shade, at).x;
      weights += weight;
    }
  }
  gl_FragColor = vec4(vec3(sum / weights), 1.0);
}`;

/** Darkens what other surfaces are near to: folds, and obstacles under a body. Drawn over the finished picture. */
export class Occlusion {
  private readonly depth = new WebGLRenderTarget(1, 1, { depthTexture: new DepthTexture(1, 1) });
  private readonly shade = new WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly depthOnly = new MeshBasicMaterial({ side: DoubleSide, colorWrite: false });
  private readonly uniforms = {
    depth: { value: this.depth.depthTexture },
    shade: { value: this.shade.texture },
    unproject: { value: new Matrix4() },
    pixel: { value: [1, 1] },
    reach: { value: 1 },
    pixels: { value: 1 },
  };
  private readonly shading = new ShaderMaterial({ vertexShader, fragmentShader: shadeShader, uniforms: this.uniforms, depthTest: false, depthWrite: false });
  private readonly blurring = new ShaderMaterial({
    vertexShader,
    fragmentShader: blurShader,
    uniforms: this.uniforms,
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendSrc: ZeroFactor,
    blendDst: SrcColorFactor,
  });
  private readonly quad = new Mesh(new PlaneGeometry(2, 2), this.shading);
  private readonly camera = new OrthographicCamera();

  constructor() {
    this.quad.frustumCulled = false;
  }

  /** After the scene was drawn into `rect`, for which the renderer and the camera are set; `radius` is that of the scene [m]. */
  draw(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera, rect: Rect, radius: number): void {
    const width = Math.max(1, Math.round(rect.width));
    const height = Math.max(1, Math.round(rect.height));
    this.depth.setSize(width, height);
    this.shade.setSize(width, height);
    this.uniforms.unproject.value = camera.projectionMatrixInverse;
    this.uniforms.pixel.value = [1 / width, 1 / height];
    this.uniforms.reach.value = REACH * radius;
    this.uniforms.pixels.value = 0.5 * height * camera.projectionMatrix.elements[5];
    const { autoClear } = renderer;
    renderer.setRenderTarget(this.depth);
    scene.overrideMaterial = this.depthOnly;
    camera.layers.set(SURFACES);
    renderer.render(scene, camera);
    camera.layers.set(0);
    scene.overrideMaterial = null;
    this.quad.material = this.shading;
    renderer.setRenderTarget(this.shade);
    renderer.render(this.quad, this.camera);
    this.quad.material = this.blurring;
    renderer.setRenderTarget(null);
    renderer.autoClear = false;
    renderer.render(this.quad, this.camera);
    renderer.autoClear = autoClear;
  }
}
