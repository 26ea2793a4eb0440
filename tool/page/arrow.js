// An arrow that shows a force.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshLambertMaterial, Vector3 } from "./vendor/three.js";

/// Length of the arrow for a force of 1 N, cm.
export const CM_PER_NEWTON = 1;
/// A force below this, N, has no arrow, because friction and dither alone cause such forces.
const LEAST = 0.15;
const LONGEST_CM = 12;
const HEAD = 0.75;
const UP = new Vector3(0, 1, 0);

export class Arrow {
  constructor() {
    this.material = new MeshLambertMaterial();
    this.shaft = new Mesh(new CylinderGeometry(0.14, 0.14, 1, 10).translate(0, 0.5, 0), this.material);
    this.head = new Mesh(new ConeGeometry(0.38, HEAD, 14).translate(0, HEAD / 2, 0), this.material);
    this.group = new Group();
    this.group.add(this.shaft, this.head);
  }

  colour(colour) {
    this.material.color.set(colour);
  }

  /// Draws `force`, N, from `point`, cm.
  show(point, force) {
    const newton = force.length();
    this.group.visible = newton > LEAST;
    if (!this.group.visible) return;
    const length = Math.min(newton * CM_PER_NEWTON, LONGEST_CM);
    const head = Math.min(1, length / (1.5 * HEAD));
    this.group.position.copy(point);
    this.group.quaternion.setFromUnitVectors(UP, force.clone().divideScalar(newton));
    this.shaft.scale.y = Math.max(length - HEAD * head, 0.001);
    this.head.position.y = length - HEAD * head;
    this.head.scale.setScalar(head);
  }
}
