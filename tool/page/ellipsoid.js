// The ellipsoid of a stiffness.

import { Matrix3 } from "./vendor/three.js";

/// Limits of the semi-axes, cm. In a direction without stiffness the semi-axis would be infinite.
const SHORTEST = 0.12;
const LONGEST = 5;

/// Returns the matrix that turns the unit sphere into the compliance ellipsoid of `stiffness` (rows, N/cm). The
/// ellipsoid shows where the tip goes under a force of `newton`, N, in any direction.
export function compliance(stiffness, newton) {
  const { values, vectors } = eigen(stiffness);
  const matrix = new Matrix3().set(0, 0, 0, 0, 0, 0, 0, 0, 0);
  const sum = matrix.elements;
  values.forEach((value, axis) => {
    const length = value > 0 ? Math.min(Math.max(newton / value, SHORTEST), LONGEST) : LONGEST;
    for (let row = 0; row < 3; row += 1) {
      for (let column = 0; column < 3; column += 1) {
        sum[column * 3 + row] += length * vectors[row][axis] * vectors[column][axis];
      }
    }
  });
  return matrix;
}

/// Returns eigenvalues and eigenvectors (columns) of the symmetric part of a 3 x 3 matrix, by Jacobi rotations.
export function eigen(matrix) {
  const a = [0, 1, 2].map((row) => [0, 1, 2].map((column) => (matrix[row][column] + matrix[column][row]) / 2));
  const vectors = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  for (let sweep = 0; sweep < 12; sweep += 1) {
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ]) {
      if (Math.abs(a[p][q]) < 1e-12) continue;
      const angle = Math.atan2(2 * a[p][q], a[q][q] - a[p][p]) / 2;
      const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
      const turnColumns = (m) =>
        m.forEach((row) => ([row[p], row[q]] = [cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]]));
      turnColumns(a);
      [a[p], a[q]] = [0, 1, 2].reduce(
        ([x, y], k) => [
          [...x, cos * a[p][k] - sin * a[q][k]],
          [...y, sin * a[p][k] + cos * a[q][k]],
        ],
        [[], []],
      );
      turnColumns(vectors);
    }
  }
  return { values: [0, 1, 2].map((k) => a[k][k]), vectors };
}
