// One finger: its links, the ghost of its set point, its ellipsoid and its force.

import { Group, Matrix4, Mesh, SphereGeometry, Vector3 } from "./vendor/three.js";
import { Arrow } from "./arrow.js";
import { compliance } from "./ellipsoid.js";
import { AROUND, RINGS } from "./quality.js";
import { paint, solid } from "./shapes.js";
import { colour } from "./theme.js";

/// The ellipsoid shows, to scale, where the tip goes under this force, N.
export const ELLIPSOID_NEWTON = 5;
const JOINTS = ["q0", "q1", "q2"];
const SET_POINT = ["d0", "d1", "d2"];
const FORCE = ["f0", "f1", "f2"];
/// The ghost is invisible if no joint is farther from the set point than this, rad, and clearest at four times that.
const GHOST_FROM = 0.03;
const GHOST_OPACITY = 0.4;
/// In each picture, the arrow goes this part of the way to a new force.
const SMOOTHING = 0.35;

/// The links as groups, each inside the group of its parent.
class Chain {
  constructor(finger, material) {
    this.root = new Group();
    this.joints = [];
    let parent = this.root;
    for (const link of finger.links) {
      const group = new Group();
      group.position.set(...link.origin);
      group.add(solid(link.shapes, material));
      parent.add(group);
      this.joints.push({ group, axis: new Vector3(...link.axis) });
      parent = group;
    }
    this.tip = new Group();
    this.tip.position.set(...finger.tip);
    parent.add(this.tip);
  }

  turn(angles) {
    this.joints.forEach(({ group, axis }, index) => group.quaternion.setFromAxisAngle(axis, angles[index]));
  }
}

export class Finger3d {
  constructor(finger, number) {
    this.colourName = `finger-${number}`;
    this.group = new Group();
    this.group.position.set(...finger.base);
    this.group.rotation.z = finger.turn;
    this.material = paint(0xffffff, { vertexColors: true });
    this.real = new Chain(finger, this.material);
    this.ghostMaterial = paint(0xffffff, { transparent: true, opacity: 0, depthWrite: false });
    this.ghost = new Chain(finger, this.ghostMaterial);
    this.ghost.root.traverse((part) => (part.castShadow = part.receiveShadow = false));
    this.ellipsoidMaterial = paint(0xffffff, { transparent: true, opacity: 0.3, depthWrite: false });
    this.ellipsoid = new Mesh(new SphereGeometry(1, 1.5 * AROUND, 3 * RINGS), this.ellipsoidMaterial);
    this.ellipsoid.matrixAutoUpdate = false;
    this.ellipsoid.renderOrder = 2;
    this.arrow = new Arrow();
    this.force = new Vector3();
    this.tip = new Vector3();
    this.group.add(
      solid(finger.shapes, this.material),
      this.real.root,
      this.ghost.root,
      this.ellipsoid,
      this.arrow.group,
    );
    this.faulted = false;
    this.real.turn(finger.start);
    this.ghost.root.visible = this.ellipsoid.visible = this.arrow.group.visible = false;
    this.colours();
  }

  colours() {
    const own = colour(this.colourName);
    this.material.color.set(this.faulted ? colour("fault-tint") : 0xffffff);
    this.ghostMaterial.color.set(own);
    this.ellipsoidMaterial.color.set(own);
    this.arrow.colour(colour("force"));
  }

  show(samples, state, time) {
    const at = (names) =>
      samples.between(
        time,
        names.map((name) => samples.columns[name]),
      );
    const joints = at(JOINTS);
    if (joints.some(Number.isNaN)) return;
    this.real.turn(joints);
    this.showGhost(joints, at(SET_POINT));
    this.group.updateWorldMatrix(true, true);
    this.tip.setFromMatrixPosition(this.real.tip.matrixWorld);
    this.group.worldToLocal(this.tip);
    this.showForce(at(FORCE));
    this.showEllipsoid(state);
    if (this.faulted !== Boolean(state?.fault)) {
      this.faulted = Boolean(state?.fault);
      this.colours();
    }
  }

  showGhost(joints, wanted) {
    const known = !wanted.some(Number.isNaN);
    const away = known ? Math.max(...wanted.map((angle, index) => Math.abs(angle - joints[index]))) : 0;
    this.ghost.root.visible = away > GHOST_FROM;
    this.ghostMaterial.opacity = Math.min((away - GHOST_FROM) / (3 * GHOST_FROM), 1) * GHOST_OPACITY;
    if (known) this.ghost.turn(wanted);
  }

  showForce(force) {
    this.force.lerp(new Vector3(...(force.some(Number.isNaN) ? [0, 0, 0] : force)), SMOOTHING);
    this.arrow.show(this.tip, this.force);
  }

  showEllipsoid(state) {
    const stiffness = state?.stiffness;
    this.ellipsoid.visible = Boolean(stiffness);
    if (!stiffness) return;
    if (this.stiffness !== stiffness) {
      this.stiffness = stiffness;
      this.scaled = new Matrix4().setFromMatrix3(compliance(stiffness, ELLIPSOID_NEWTON));
    }
    this.ellipsoid.matrix.copy(this.scaled).setPosition(this.tip);
    this.ellipsoid.matrixWorldNeedsUpdate = true;
  }
}
