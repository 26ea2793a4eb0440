// The object of the simulation, and its table.

import {
  BoxGeometry,
  BufferGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
} from "./vendor/three.js";
import { paint, solid } from "./shapes.js";
import { colour, onColours } from "./theme.js";

const TABLE_RADIUS = 13;
/// In each picture, the object goes this part of the remaining way to the newest state. 20 states arrive per second.
const SMOOTHING = 0.3;

/// Returns lines on the surface, which show how the object turns: the edges of a box, three circles around a ball.
function marks(shape) {
  if (shape.form !== "sphere") return new EdgesGeometry(new BoxGeometry(...shape.size));
  const points = [];
  const at = (part, axis) => {
    const angle = (part * Math.PI) / 32;
    const place = [Math.cos(angle), Math.sin(angle), 0].map((value) => value * shape.radius * 1.006);
    return new Vector3(...place.slice(axis), ...place.slice(0, axis));
  };
  for (let axis = 0; axis < 3; axis += 1) {
    for (let part = 0; part < 64; part += 1) points.push(at(part, axis), at(part + 1, axis));
  }
  return new BufferGeometry().setFromPoints(points);
}

export class Object3d {
  constructor({ shape, position, table }) {
    this.group = new Group();
    this.body = new Group();
    this.lines = new LineBasicMaterial();
    const body = solid([{ ...shape, fine: true }], paint(0xffffff, { vertexColors: true }));
    this.body.add(body, new LineSegments(marks(shape), this.lines));
    this.body.position.set(...position);
    this.group.add(this.body);
    if (table) this.addTable(table);
    onColours(() => this.colours());
  }

  addTable({ point, up }) {
    this.table = paint(0xffffff, { side: DoubleSide });
    const mesh = new Mesh(new CylinderGeometry(TABLE_RADIUS, TABLE_RADIUS, 0.4, 48).translate(0, -0.2, 0), this.table);
    mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...up));
    mesh.position.set(...point);
    mesh.receiveShadow = true;
    this.group.add(mesh);
  }

  colours() {
    this.lines.color.set(colour("object-line"));
    this.table?.color.set(colour("table"));
  }

  /// Moves the object towards a state: position, cm, and rotation matrix by rows.
  show(state) {
    if (!state) return;
    const [[a, b, c], [d, e, f], [g, h, i]] = state.rotation;
    const turned = new Quaternion().setFromRotationMatrix(
      new Matrix4().set(a, b, c, 0, d, e, f, 0, g, h, i, 0, 0, 0, 0, 1),
    );
    this.body.position.lerp(new Vector3(...state.position), SMOOTHING);
    this.body.quaternion.slerp(turned, SMOOTHING);
  }
}
