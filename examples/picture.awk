# Joins OBJ files into one. The input is a sequence of files, each after a `usemtl` line. Indices are shifted and UVs dropped. `l` elements
# become prisms and beads of `radius`. A line `shift X` moves all files after it by X along x.
$1 == "shift" { moved += $2; next }
$1 == "usemtl" { offset = total; print; next }
$1 == "v" { ++total; x[total] = $2 + moved; y[total] = $3; z[total] = $4; number[total] = vertex(x[total], y[total], z[total]); next }
$1 == "f" {
  printf "f"
  for (i = 2; i <= NF; ++i) { split($i, corner, "/"); printf " %d", number[corner[1] + offset] }
  print ""
  next
}
$1 == "l" { for (i = 2; i < NF; ++i) segment($i + offset, $(i + 1) + offset) }

function vertex(px, py, pz) { printf "v %.9g %.9g %.9g\n", px, py, pz; return ++written }

function segment(a, b,    dx, dy, dz, n, ux, uy, uz, m, wx, wy, wz, k, c, s, p, q) {
  bead(a); bead(b)
  dx = x[b] - x[a]; dy = y[b] - y[a]; dz = z[b] - z[a]
  n = sqrt(dx * dx + dy * dy + dz * dz)
  if (n == 0) return
  dx /= n; dy /= n; dz /= n
  if (dx * dx < 0.5) { ux = 0; uy = dz; uz = -dy } else { ux = -dz; uy = 0; uz = dx }
  m = sqrt(ux * ux + uy * uy + uz * uz); ux /= m; uy /= m; uz /= m
  wx = dy * uz - dz * uy; wy = dz * ux - dx * uz; wz = dx * uy - dy * ux
  for (k = 0; k < 8; ++k) {
    c = radius * cos(k * 0.7853981634); s = radius * sin(k * 0.7853981634)
    p[k] = vertex(x[a] + c * ux + s * wx, y[a] + c * uy + s * wy, z[a] + c * uz + s * wz)
    q[k] = vertex(x[b] + c * ux + s * wx, y[b] + c * uy + s * wy, z[b] + c * uz + s * wz)
  }
  for (k = 0; k < 8; ++k) printf "f %d %d %d %d\n", p[k], p[(k + 1) % 8], q[(k + 1) % 8], q[k]
}

function bead(a,    r, i, v) {
  if (a in beads) return
  beads[a] = 1
  r = 1.6 * radius
  for (i = 0; i < 6; ++i) v[i] = vertex(x[a] + (i == 0 ? r : i == 1 ? -r : 0), y[a] + (i == 2 ? r : i == 3 ? -r : 0), z[a] + (i == 4 ? r : i == 5 ? -r : 0))
  for (i = 0; i < 8; ++i)
    if ((i % 2 + int(i / 2) % 2 + int(i / 4)) % 2 == 0) printf "f %d %d %d\n", v[i % 2], v[2 + int(i / 2) % 2], v[4 + int(i / 4)]
    else printf "f %d %d %d\n", v[i % 2], v[4 + int(i / 4)], v[2 + int(i / 2) % 2]
}
