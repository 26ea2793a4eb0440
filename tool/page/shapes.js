// The shapes of which the hand and its surroundings consist.

import {
  BoxGeometry,
  BufferAttribute,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  Quaternion,
  SphereGeometry,
  Vector3,
  mergeGeometries,
} from "./vendor/three.js";
import { AROUND, RINGS } from "./quality.js";

const UP = new Vector3(0, 1, 0);

/// Returns a material like matt paint.
export function paint(colour, options = {}) {
  return new MeshLambertMaterial({ color: colour, ...options });
}

/// Returns one mesh for all shapes of a body. Each shape has its own colour, which the colour of the material tints.
export function solid(shapes, material) {
  const mesh = new Mesh(mergeGeometries(shapes.map(coloured)), material);
  mesh.castShadow = mesh.receiveShadow = true;
  return mesh;
}

function coloured(shape) {
  const geometry = formed(shape);
  const colour = new Color(shape.colour);
  const colours = new Float32Array(geometry.attributes.position.count * 3);
  for (let place = 0; place < colours.length; place += 3) colours.set([colour.r, colour.g, colour.b], place);
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
  return geometry;
}

function formed(shape) {
  switch (shape.form) {
    case "capsule":
      return between(shape, new CapsuleGeometry(shape.radius, distance(shape), RINGS, AROUND));
    case "cylinder":
      return between(shape, new CylinderGeometry(shape.radius, shape.radius, distance(shape), AROUND));
    case "sphere":
      return new SphereGeometry(shape.radius, ...(shape.fine ? [32, 20] : [AROUND, 2 * RINGS])).translate(
        ...shape.centre,
      );
    default:
      return new BoxGeometry(...shape.size).translate(...shape.centre);
  }
}

function distance({ from, to }) {
  return new Vector3(...from).distanceTo(new Vector3(...to));
}

/// Turns and moves a geometry, whose axis is y, so that it lies between two points.
function between({ from, to }, geometry) {
  const [start, end] = [new Vector3(...from), new Vector3(...to)];
  const turn = new Quaternion().setFromUnitVectors(UP, end.clone().sub(start).normalize());
  return geometry.applyMatrix4(new Matrix4().compose(start.lerp(end, 0.5), turn, new Vector3(1, 1, 1)));
}
