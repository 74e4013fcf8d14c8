/** The solid ellipsoid of the same mass and inertia. */
import { Matrix4, Vector3 } from "three";
import type { Inertia } from "./scene";

const ROUNDS = 32;
const PAIRS: readonly (readonly [number, number])[] = [[0, 1], [0, 2], [1, 2]];

type Matrix = [number[], number[], number[]];

/** Return the unit sphere's way to the ellipsoid, turned but not moved; null without mass or inertia. */
export function ellipsoid(inertia: Inertia, mass: number): Matrix4 | null {
  const [xx, yy, zz, xy, xz, yz] = inertia.moments;
  const { moments, axes } = principal([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
  const sum = moments[0]! + moments[1]! + moments[2]!;
  if (!(mass > 0) || !(sum > 0)) return null;
  // I1 = m (b² + c²) / 5, and so on; what no solid has gets no thickness.
  const half = moments.map((moment) => Math.sqrt(Math.max((2.5 / mass) * (sum - 2 * moment), 1e-6 * (sum / mass))));
  const [x, y, z] = axes.map((axis, index) => axis.multiplyScalar(half[index]!)) as [Vector3, Vector3, Vector3];
  return new Matrix4().makeBasis(x, y, z);
}

/** Return eigenvalues and eigenvectors, right-handed, of a symmetric matrix: rotations of Jacobi. */
function principal(symmetric: Matrix): { moments: number[]; axes: Vector3[] } {
  const matrix = symmetric.map((row) => [...row]) as Matrix;
  const turned: Matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let round = 0; round < ROUNDS; round++) {
    const [p, q] = largest(matrix);
    if (matrix[p]![q] === 0) break;
    const angle = Math.atan2(2 * matrix[p]![q]!, matrix[q]![q]! - matrix[p]![p]!) / 2;
    rotate(matrix, turned, p, q, Math.cos(angle), Math.sin(angle));
  }
  const axes = [0, 1, 2].map((column) => new Vector3(...(turned.map((row) => row[column]!) as [number, number, number])));
  if (axes[0]!.clone().cross(axes[1]!).dot(axes[2]!) < 0) axes[2]!.negate();
  return { moments: [0, 1, 2].map((index) => matrix[index]![index]!), axes };
}

/** Return the row and column, over the diagonal, of the number that is farthest from 0. */
function largest(matrix: Matrix): readonly [number, number] {
  const size = ([row, column]: readonly [number, number]): number => Math.abs(matrix[row]![column]!);
  return PAIRS.reduce((best, pair) => (size(pair) > size(best) ? pair : best));
}

/** Turn the columns and rows p and q of the matrix, and the columns of the axes. */
function rotate(matrix: Matrix, turned: Matrix, p: number, q: number, cos: number, sin: number): void {
  for (const row of [...matrix, ...turned]) {
    [row[p], row[q]] = [cos * row[p]! - sin * row[q]!, sin * row[p]! + cos * row[q]!];
  }
  for (let column = 0; column < 3; column++) {
    const [above, below] = [matrix[p]![column]!, matrix[q]![column]!];
    matrix[p]![column] = cos * above - sin * below;
    matrix[q]![column] = sin * above + cos * below;
  }
  matrix[p]![q] = matrix[q]![p] = 0;
}
