import type { Mesh } from '../run/protocol';

/** Area-weighted vertex normals. */
export function vertexNormals(positions: Float32Array, triangles: Uint32Array, normals: Float32Array): void {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy;
    const y = uz * vx - ux * vz;
    const z = ux * vy - uy * vx;
    normals[a] += x;
    normals[a + 1] += y;
    normals[a + 2] += z;
    normals[b] += x;
    normals[b + 1] += y;
    normals[b + 2] += z;
    normals[c] += x;
    normals[c + 1] += y;
    normals[c + 2] += z;
  }
  // Math.hypot would take half of the time.
  for (let k = 0; k < normals.length; k += 3) {
    const x = normals[k];
    const y = normals[k + 1];
    const z = normals[k + 2];
    const inverse = 1 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[k] = x * inverse;
    normals[k + 1] = y * inverse;
    normals[k + 2] = z * inverse;
  }
}

/** Positions and normals of each corner. Edges sharper than the angle stay sharp. */
export function creased(mesh: Mesh, degrees = 35): { positions: Float32Array; normals: Float32Array } {
  const { vertices, triangles } = mesh;
  const corners = triangles.length;
  const positions = new Float32Array(3 * corners);
  const faces = new Float32Array(corners);
  const first = new Uint32Array(vertices.length / 3 + 1);
  for (let k = 0; k < corners; ++k) {
    positions.set(vertices.subarray(3 * triangles[k], 3 * triangles[k] + 3), 3 * k);
    ++first[triangles[k] + 1];
  }
  for (let i = 1; i < first.length; ++i) first[i] += first[i - 1];
  // The faces around each vertex, one list after the other.
  const around = new Uint32Array(corners);
  const next = first.slice();
  for (let k = 0; k < corners; ++k) around[next[triangles[k]]++] = k - (k % 3);
  const areas = new Float32Array(corners);
  const identity = new Uint32Array(3);
  const normals = new Float32Array(9);
  for (let t = 0; t < corners; t += 3) {
    identity.set([0, 1, 2]);
    const corner = positions.subarray(3 * t, 3 * t + 9);
    vertexNormals(corner, identity, normals);
    faces.set(normals.subarray(0, 3), t);
    areas[t] = area(corner);
  }
  const limit = Math.cos((degrees * Math.PI) / 180);
  const result = new Float32Array(3 * corners);
  for (let k = 0; k < corners; ++k) {
    const own = k - (k % 3);
    let x = 0;
    let y = 0;
    let z = 0;
    for (let j = first[triangles[k]]; j < first[triangles[k] + 1]; ++j) {
      const face = around[j];
      const cosine = faces[face] * faces[own] + faces[face + 1] * faces[own + 1] + faces[face + 2] * faces[own + 2];
      if (cosine < limit) continue;
      x += areas[face] * faces[face];
      y += areas[face] * faces[face + 1];
      z += areas[face] * faces[face + 2];
    }
    const length = Math.hypot(x, y, z) || 1;
    result[3 * k] = x / length;
    result[3 * k + 1] = y / length;
    result[3 * k + 2] = z / length;
  }
  return { positions, normals: result };
}

function area(p: Float32Array): number {
  const ux = p[3] - p[0];
  const uy = p[4] - p[1];
  const uz = p[5] - p[2];
  const vx = p[6] - p[0];
  const vy = p[7] - p[1];
  const vz = p[8] - p[2];
  return Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
}
