// The cards of the fingers, and the details of the selected one.

import { element } from "./element.js";

const DEGREES = 180 / Math.PI;
const COLUMNS = [
  "q0",
  "q1",
  "q2",
  "d0",
  "d1",
  "d2",
  "t0",
  "t1",
  "t2",
  "t3",
  "w0",
  "w1",
  "w2",
  "w3",
  "f0",
  "f1",
  "f2",
  "p0",
  "p1",
  "p2",
  "torque_scale",
  "stiffness_scale",
];

/// Facts about a finger, and what they mean.
const FACTS = [
  ["tip", "Position of the fingertip in the palm's frame"],
  ["tip force", "Magnitude of the measured force of the fingertip"],
  ["scales", "Scale of the joint torques (1: the tendons make them in full) and of Kx (1: full effect in this pose)"],
  ["wake, cycle 99.9 %", "Wake-up delay and cycle duration that 99.9 % of the servo's cycles do not exceed"],
  ["lost, skipped", "Replies of the board that were lost, and periods that were skipped, since the hand was opened"],
];

const fixed = (value, decimals) => (Number.isFinite(value) ? value.toFixed(decimals).replace("-", "−") : "–");

/// A horizontal bar with a mark for the measured value and a tick for the wanted one.
class Bar {
  constructor(label, low, high, filled) {
    Object.assign(this, { low, high });
    this.value = element("span", "number");
    this.mark = element("i", filled ? "fill" : "mark");
    this.wanted = element("i", "wanted");
    this.track = element("div", "track", this.mark, this.wanted);
    this.row = element("div", "bar", element("label", "", label), this.track, this.value);
  }

  share(value) {
    return Math.min(Math.max((value - this.low) / (this.high - this.low), 0), 1) * 100;
  }

  show(value, wanted, text, alarming) {
    const known = Number.isFinite(value);
    this.mark.style[this.mark.className === "fill" ? "width" : "left"] = `${known ? this.share(value) : 0}%`;
    this.wanted.hidden = !Number.isFinite(wanted);
    this.wanted.style.left = `${this.share(wanted)}%`;
    this.value.textContent = text;
    this.row.classList.toggle("alarming", alarming);
  }
}

/// The card of one finger, a tab.
class Card {
  constructor(finger, select) {
    this.state = element("span", "state");
    this.small = element("small", "");
    this.button = element("button", "card", element("b", "", `Finger ${finger.number}`), this.state, this.small);
    this.button.dataset.finger = finger.number;
    this.button.setAttribute("role", "tab");
    this.button.addEventListener("click", () => select(finger.number));
    this.place = finger.simulated ? "simulated" : "real";
  }

  show(state, values, selected) {
    this.button.setAttribute("aria-selected", selected);
    const stage = state?.fault ? "fault" : (state?.stage ?? "waiting");
    this.state.textContent = state?.fault ? state.fault.name : stage;
    this.state.dataset.stage = stage;
    const force = values ? Math.hypot(values.f0, values.f1, values.f2) : NaN;
    this.small.textContent = `tip ${fixed(force, 1)} N · ${this.place}`;
  }
}

export class Panel {
  constructor(tabs, detail, select) {
    Object.assign(this, { tabs, detail, select, cards: new Map() });
  }

  begin(fingers) {
    this.fingers = new Map(fingers.map((finger) => [finger.number, finger]));
    this.cards = new Map(fingers.map((finger) => [finger.number, new Card(finger, this.select)]));
    this.tabs.replaceChildren(...[...this.cards.values()].map((card) => card.button));
    this.built = null;
  }

  build(finger) {
    this.built = finger.number;
    this.joints = finger.links.map((joint, index) => new Bar(`joint ${index}`, ...joint.limits, false));
    this.tensions = [1, 2, 3, 4].map((tendon) => new Bar(`tendon ${tendon}`, 0, finger.tension.high, true));
    const least = element("i", "least");
    for (const bar of this.tensions) {
      least.style.left = `${bar.share(finger.tension.low)}%`;
      bar.track.append(least.cloneNode());
    }
    this.matrix = Array.from({ length: 9 }, () => element("td", ""));
    const rows = [0, 1, 2].map((row) => element("tr", "", ...this.matrix.slice(3 * row, 3 * row + 3)));
    const facts = element(
      "dl",
      "facts",
      ...FACTS.map(([name, title]) => {
        const box = element("div", "", element("dt", "", name), element("dd", ""));
        box.title = title;
        return box;
      }),
    );
    this.facts = [...facts.querySelectorAll("dd")];
    this.detail.replaceChildren(
      element(
        "div",
        "column",
        element("h3", "", "Joints ", element("small", "", "°, bars from limit to limit")),
        ...this.joints.map((bar) => bar.row),
        element("h3", "", "Kx ", element("small", "", "N/cm")),
        element("table", "matrix", element("tbody", "", ...rows)),
      ),
      element(
        "div",
        "column",
        element("h3", "", "Tensions ", element("small", "", tensionsNote(finger))),
        ...this.tensions.map((bar) => bar.row),
        facts,
      ),
    );
  }

  /// Shows the values at `time`.
  show(samples, states, statuses, selected, time) {
    for (const [number, card] of this.cards) {
      card.show(states.get(number), values(samples.get(number), time), number === selected);
    }
    const finger = this.fingers?.get(selected);
    if (!finger) return;
    if (this.built !== selected) this.build(finger);
    this.showValues(finger, values(samples.get(selected), time), states.get(selected), statuses.get(selected));
  }

  showValues(finger, now, state, status) {
    if (!now) return;
    this.joints.forEach((bar, index) => {
      const angle = now[`q${index}`];
      const outside = angle < bar.low || angle > bar.high;
      bar.show(angle, now[`d${index}`], fixed(angle * DEGREES, 1), outside);
    });
    this.tensions.forEach((bar, index) => {
      const tension = now[`t${index}`];
      const outside = tension > finger.tension.high || tension < 0.8 * finger.tension.low;
      bar.show(tension, now[`w${index}`], fixed(tension, 1), outside);
    });
    this.matrix.forEach((cell, index) => (cell.textContent = fixed(state?.kx?.[(index / 3) | 0][index % 3], 2)));
    const tip = [now.p0, now.p1, now.p2].map((value) => fixed(value, 2)).join("  ");
    [
      `${tip} cm`,
      `${fixed(Math.hypot(now.f0, now.f1, now.f2), 2)} N`,
      `${fixed(now.torque_scale, 2)}, ${fixed(now.stiffness_scale, 2)}`,
      `${fixed(status?.wake_up?.p999, 0)}, ${fixed(status?.cycle?.p999, 0)} µs`,
      `${status?.lost_replies ?? "–"}, ${status?.skipped_periods ?? "–"}`,
    ].forEach((text, index) => (this.facts[index].textContent = text));
  }
}

function tensionsNote(finger) {
  return `N, t_min ${finger.tension.low} to t_max ${finger.tension.high}`;
}

function values(samples, time) {
  const found = samples?.between(
    time,
    COLUMNS.map((name) => samples.columns[name]),
  );
  return found && Object.fromEntries(COLUMNS.map((name, index) => [name, found[index]]));
}
