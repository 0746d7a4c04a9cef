/** The presets of `sprung materials`, by what they are for. */
const CLOTHS = ['cotton', 'silk', 'wool', 'denim', 'jersey', 'leather', 'felt', 'paper', 'rubber_sheet'];
const ROPES = ['hemp', 'nylon', 'steel_cable', 'hair'];
const SOLIDS = ['soft_jelly', 'firm_jelly', 'foam', 'rubber_block'];

/** The materials that a body of a shape may have, `own` among them. */
export function materialsFor(shape: string, own: string): string[] {
  const solid = shape === 'solid' || shape === 'lattice' || shape === 'tetrahedra';
  const names = shape === 'rope' ? ROPES : solid ? SOLIDS : CLOTHS;
  return names.includes(own) ? names : [own, ...names];
}
