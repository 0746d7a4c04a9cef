// Plays the glTF file with three's GLTFLoader and reads the USD file with its USDLoader, and compares vertices with record.bin.
// Arguments: the folder of three, the folder of a run, and that of its exports.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [threeFolder, run, exports] = process.argv.slice(2);
const load = (path) => import(pathToFileURL(`${threeFolder}/${path}`).href);
globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};
const THREE = await load("build/three.module.js");
const { GLTFLoader } = await load("examples/jsm/loaders/GLTFLoader.js");
const { USDLoader } = await load("examples/jsm/loaders/USDLoader.js");

const kRounding = 2 ** -21;

class Record {
  constructor(folder) {
    const data = readFileSync(`${folder}/record.bin`);
    const size = Number(data.readBigUInt64LE(16));
    this.head = JSON.parse(data.subarray(24, 24 + size).toString());
    this.data = data;
    this.arrays = 24 + size;
    this.first = this.arrays + this.head.array_bytes;
    this.frames = Math.floor((data.length - this.first) / this.head.frame_bytes);
  }
  numbers(entry, begin) {
    const count = entry.shape[0] * entry.shape[1];
    const at = begin + entry.offset;
    if (entry.type === "f64") return Array.from({ length: count }, (_, k) => this.data.readDoubleLE(at + 8 * k));
    return Array.from({ length: count }, (_, k) => this.data.readInt32LE(at + 4 * k));
  }
  array(name) {
    return this.numbers(this.head.arrays[name], this.arrays);
  }
  frame(name, frame) {
    return this.numbers(this.head.frame_arrays[name], this.first + (frame - 1) * this.head.frame_bytes);
  }
  vertices(body, frame) {
    const positions = this.frame("positions", frame);
    return this.array(`bodies/${body}/particle_of`).flatMap((p) => positions.slice(3 * p, 3 * p + 3));
  }
}

function check(found, wanted, what) {
  if (found.length < wanted.length) throw new Error(`${what}: ${found.length / 3} vertices, expected ${wanted.length / 3}`);
  const extent = Math.max(1, ...wanted.map(Math.abs));
  for (let k = 0; k < wanted.length; ++k) {
    if (!(Math.abs(found[k] - wanted[k]) <= kRounding * extent)) throw new Error(`${what}: off by ${found[k] - wanted[k]} at ${k}`);
  }
}

/// The vertices of a mesh as they are drawn.
function drawn(mesh) {
  const count = mesh.geometry.attributes.position.count;
  const { position } = mesh.geometry.attributes;
  const targets = mesh.geometry.morphAttributes.position ?? [];
  const point = new THREE.Vector3();
  const moved = new THREE.Vector3();
  return Array.from({ length: count }, (_, k) => {
    point.fromBufferAttribute(position, k);
    targets.forEach((target, t) => {
      if (mesh.morphTargetInfluences[t] !== 0) point.addScaledVector(moved.fromBufferAttribute(target, k), mesh.morphTargetInfluences[t]);
    });
    return point.applyMatrix4(mesh.matrixWorld).toArray();
  }).flat();
}

const record = new Record(run);
const bytes = readFileSync(`${exports}/animation.glb`);
const gltf = await new Promise((done, fail) =>
  new GLTFLoader().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "", done, fail));
const mixer = new THREE.AnimationMixer(gltf.scene);
for (const clip of gltf.animations) {
  const action = mixer.clipAction(clip).setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
}
for (const frame of [1, Math.ceil(record.frames / 2), record.frames]) {
  mixer.setTime(Math.fround(record.frame("time", frame)[0])); // times of keys are floats
  gltf.scene.updateMatrixWorld(true);
  record.head.bodies.forEach((body, b) => {
    const mesh = gltf.scene.getObjectByName(body.name);
    const first = mesh.isMesh || mesh.isLineSegments ? mesh : mesh.children[0];
    check(drawn(first), record.vertices(b, frame), `${body.name} in glTF, frame ${frame}`);
  });
}

const scene = new USDLoader().parse(readFileSync(`${exports}/animation.usda`).toString());
scene.updateMatrixWorld(true);
for (const [b, body] of record.head.bodies.entries()) {
  if (record.array(`bodies/${b}/corner_begin`).length < 2) continue; // the loader knows no curves
  const mesh = scene.getObjectByName(body.name.replaceAll("-", "_"));
  if (!mesh) throw new Error(`${body.name} is not in USD`);
  const found = drawn(mesh.isMesh || mesh.isLineSegments ? mesh : mesh.children[0]);
  const wanted = record.vertices(b, 1);
  // The loader unfolds faces into corners of their own: every one of them is a vertex of the body.
  const extent = Math.max(1, ...wanted.map(Math.abs));
  const places = new Set();
  const key = (x, y, z) => [x, y, z].map((c) => Math.round(c / (64 * kRounding * extent))).join();
  for (let k = 0; k < wanted.length; k += 3) {
    for (const dx of [-1, 0, 1]) for (const dy of [-1, 0, 1]) for (const dz of [-1, 0, 1]) {
      const step = 64 * kRounding * extent;
      places.add(key(wanted[k] + dx * step, wanted[k + 1] + dy * step, wanted[k + 2] + dz * step));
    }
  }
  for (let k = 0; k < found.length; k += 3) {
    if (!places.has(key(found[k], found[k + 1], found[k + 2]))) throw new Error(`${body.name} in USD: corner ${k / 3} is at no vertex`);
  }
  if (found.length === 0) throw new Error(`${body.name} in USD has no vertices`);
}
console.log(`${record.head.bodies.length} bodies, ${record.frames} frames: equal`);
