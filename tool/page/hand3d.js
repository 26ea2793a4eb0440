// The hand: the palm, the fingers, and on each fingertip the ellipsoid of its compliance and the arrow of its force.

import { Group } from "./vendor/three.js";
import { Finger3d } from "./finger3d.js";
import { paint, solid } from "./shapes.js";
import { onColours } from "./theme.js";

export class Hand3d {
  constructor(geometry) {
    this.group = new Group();
    this.group.add(solid(geometry.palm, paint(0xffffff, { vertexColors: true })));
    this.fingers = new Map(geometry.fingers.map((finger) => [finger.number, new Finger3d(finger, finger.number)]));
    for (const finger of this.fingers.values()) this.group.add(finger.group);
    onColours(() => {
      for (const finger of this.fingers.values()) finger.colours();
    });
  }

  /// Shows the fingers at `time`. `samples` and `states` are maps by finger number. Returns whether there are samples.
  show(samples, states, time) {
    let any = false;
    for (const [number, finger] of this.fingers) {
      const of = samples.get(number);
      if (of?.count) finger.show(of, states.get(number), time);
      any ||= of?.count > 0;
    }
    return any;
  }
}
