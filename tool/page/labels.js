// The numbers of the fingers in the 3-D view.

import { Vector3 } from "./vendor/three.js";
import { element } from "./element.js";

/// Place of the number in the finger's frame, cm: behind the base, away from the palm.
const PLACE = new Vector3(0, 2.1, -0.9);

export class Labels {
  constructor(parent, view) {
    Object.assign(this, { parent, view, labels: [] });
  }

  begin(hand) {
    this.labels = [...hand.fingers].map(([number, finger]) => {
      const label = element("b", "", String(number));
      label.dataset.finger = number;
      return { label, finger };
    });
    this.parent.replaceChildren(...this.labels.map(({ label }) => label));
  }

  show() {
    const { clientWidth: width, clientHeight: height } = this.view.canvas;
    for (const { label, finger } of this.labels) {
      const place = finger.group.localToWorld(PLACE.clone()).project(this.view.camera);
      const x = ((place.x + 1) / 2) * width;
      const y = ((1 - place.y) / 2) * height;
      label.style.transform = `translate(${x}px, ${y}px) translate(-50%, -50%)`;
    }
  }
}
