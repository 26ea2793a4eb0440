// The panel that moves the hand. The server offers it only with --control.

import { element } from "./element.js";

const DEGREES = 180 / Math.PI;
const SEND_MS = 60;
/// Largest step of a joint of a real finger, rad. sun2xp refuses steps of more than 0.0524 rad.
const REAL_STEP = 0.045;
const TIP_STEP_CM = 0.08;
const AXES = ["x", "y", "z"];
const MESSAGE_MS = 6000;
/// Time after which the panel warns that a stop has no answer. The server answers within a few milliseconds.
const STOP_ANSWER_MS = 500;
/// The answer to a stop.
const STOPPED = "all fingers are stopped";

/// The functions that end the presses of the held buttons.
const holds = new Set();

/// Releases all held buttons. A button that leaves the page, or whose page loses the focus, may get no event for the
/// end of the press.
function releaseAll() {
  for (const stop of holds) stop();
}

window.addEventListener("blur", releaseAll);
document.addEventListener("visibilitychange", releaseAll);

/// Calls `act` at once, and repeatedly while the button is held. Calls `end` when the button is released.
function held(button, act, end = () => {}) {
  let timer = null;
  const stop = () => {
    if (timer === null) return;
    clearInterval(timer);
    timer = null;
    holds.delete(stop);
    button.classList.remove("held");
    end();
  };
  button.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || timer !== null) return;
    button.setPointerCapture(event.pointerId);
    button.classList.add("held");
    holds.add(stop);
    timer = setInterval(act, SEND_MS);
    act();
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) button.addEventListener(name, stop);
  button.addEventListener("contextmenu", (event) => event.preventDefault());
}

function button(text, title, act, className = "") {
  const made = element("button", className, text);
  made.type = "button";
  made.title = title;
  if (act) made.addEventListener("click", act);
  return made;
}

export class Control {
  /// `send(message)` sends a command. `desired(finger)` returns the joint angles of the set point in force.
  /// `opened(width)` is called with the width of the panel, pixels, or with 0 if the panel is hidden.
  constructor(form, toggle, { send, desired, opened }) {
    Object.assign(this, { form, toggle, send, desired, opened, finger: null, wanted: null, stopping: false });
    form.addEventListener("submit", (event) => event.preventDefault());
    toggle.addEventListener("click", () => this.open(form.hidden));
    setInterval(() => this.step(), SEND_MS);
  }

  open(shown) {
    this.form.hidden = !shown;
    this.toggle.setAttribute("aria-expanded", shown);
    this.opened(shown ? this.form.offsetWidth : 0);
  }

  begin(hand) {
    releaseAll();
    this.toggle.hidden = !hand.control;
    this.hand = hand;
    this.finger = null;
    this.open(hand.control);
  }

  /// Shows the panel of a finger, and its set point.
  show(number, state) {
    if (!this.hand?.control || this.form.hidden) return;
    const finger = this.hand.fingers.find((one) => one.number === number);
    if (this.finger !== finger) this.build(finger);
    const joints = this.desired(number);
    this.sliders.forEach(({ input, value }, joint) => {
      if (this.wanted?.[joint] === undefined && joints) input.value = joints[joint] * DEGREES;
      value.textContent = `${Math.round(input.value)}°`.replace("-", "−");
    });
    this.recover.disabled = !(state?.fault || ["limp", "closed"].includes(state?.stage));
    this.inputs.forEach((input, axis) => {
      if (document.activeElement !== input && state?.kx) input.value = state.kx[axis][axis].toFixed(2);
    });
  }

  build(finger) {
    releaseAll();
    this.finger = finger;
    this.wanted = null;
    const command = (name, values = {}) => this.order(name, values);
    this.recover = button("Recover", "Make the stopped finger a spring again, in its present pose", () =>
      command("recover", { finger: finger.number }),
    );
    this.message = element("p", "message", "");
    this.form.replaceChildren(
      element("h3", "", `Finger ${finger.number}`),
      element(
        "div",
        "row",
        button("Open", "Move all fingers apart", () => command("open")),
        button("Close", "Move all fingers to the middle", () => command("close")),
        this.recover,
        button("Stop", "Stop all fingers at once (space bar)", () => command("stop"), "stop"),
      ),
      element("fieldset", "", element("legend", "", "joints"), ...this.jointRows(finger)),
      element("fieldset", "", element("legend", "", "tip, in the finger's frame"), this.tipRow(finger)),
      element("fieldset", "", element("legend", "", "Kx along x, y, z, N/cm"), this.stiffnessRow(finger)),
      ...(finger.simulated ? [this.pushes(finger)] : []),
      this.message,
    );
    if (this.stopping) this.warn();
  }

  jointRows(finger) {
    this.sliders = finger.links.map(({ limits }, joint) => {
      const input = element("input", "");
      Object.assign(input, { type: "range", step: "any", min: limits[0] * DEGREES, max: limits[1] * DEGREES });
      input.setAttribute("aria-label", `joint ${joint}, degrees`);
      input.addEventListener("input", () => {
        this.wanted ??= [];
        this.last = null;
        this.wanted[joint] = input.value / DEGREES;
      });
      // A real finger moves towards the slider only while the slider is held.
      input.addEventListener("change", () => finger.simulated || (this.wanted = null));
      return { input, value: element("span", "number", "") };
    });
    return this.sliders.map(({ input, value }, joint) => element("label", "slide", `${joint}`, input, value));
  }

  tipRow(finger) {
    const move = (axis, sign) => {
      const by = [0, 0, 0];
      by[axis] = sign * TIP_STEP_CM;
      this.order("move_tip", { finger: finger.number, by });
    };
    return element(
      "div",
      "row axes",
      ...this.axisButtons("Move the fingertip", (made, axis, sign) => held(made, () => move(axis, sign))),
    );
  }

  stiffnessRow(finger) {
    this.inputs = AXES.map((axis) => {
      const input = element("input", "");
      Object.assign(input, { type: "number", min: 0, step: 0.1 });
      input.setAttribute("aria-label", `stiffness along ${axis}, N/cm`);
      return input;
    });
    const set = () => {
      const kx = [0, 1, 2].map((row) =>
        [0, 1, 2].map((column) => (row === column ? Number(this.inputs[row].value) : 0)),
      );
      this.order("stiffness", { finger: finger.number, kx });
    };
    const scale = (factor) => this.order("scale_stiffness", { finger: finger.number, factor });
    return element(
      "div",
      "row",
      ...this.inputs,
      button("Set", "Send this stiffness", set),
      button("softer", "Multiply the stiffness by 0.8", () => scale(0.8)),
      button("stiffer", "Multiply the stiffness by 1.25", () => scale(1.25)),
    );
  }

  pushes(finger) {
    const newton = element("input", "");
    Object.assign(newton, { type: "range", min: 0.5, max: 6, step: 0.5, value: 2 });
    newton.setAttribute("aria-label", "force of the push, N");
    const legend = element("legend", "", "");
    const show = () => (legend.textContent = `push with ${newton.value} N while held`);
    newton.addEventListener("input", show);
    show();
    const push = (force) => this.order("push", { finger: finger.number, force });
    const buttons = this.axisButtons("Push the fingertip", (made, axis, sign) => {
      // The hand keeps a push, so it is sent once.
      let pushes = false;
      const begin = () => {
        if (pushes) return;
        pushes = true;
        // A button whose push was not sent does not stay pressed.
        if (!push([0, 1, 2].map((one) => (one === axis ? sign * newton.value : 0)))) releaseAll();
      };
      const end = () => {
        pushes = false;
        push([0, 0, 0]);
      };
      held(made, begin, end);
    });
    return element(
      "fieldset",
      "",
      legend,
      element("label", "slide", "N", newton),
      element("div", "row axes", ...buttons),
    );
  }

  axisButtons(title, connect) {
    return AXES.flatMap((name, axis) =>
      [-1, 1].map((sign) => {
        const text = `${sign < 0 ? "−" : "+"}${name}`;
        const made = button(text, `${title} along ${text}, while held`);
        connect(made, axis, sign);
        return made;
      }),
    );
  }

  /// Sends the next step towards the sliders.
  step() {
    const joints = this.finger && this.wanted && this.desired(this.finger.number);
    if (!joints) return;
    const most = this.finger.simulated ? Infinity : REAL_STEP;
    const next = joints.map(
      (angle, joint) => angle + Math.min(Math.max((this.wanted[joint] ?? angle) - angle, -most), most),
    );
    const key = next.join();
    if (key !== this.last) this.order("joints", { finger: this.finger.number, joints: next });
    this.last = key;
    const arrived = this.wanted.every((angle, joint) => Math.abs(angle - joints[joint]) < 1e-3);
    if (arrived) this.wanted = null;
  }

  /// Sends a command. Returns whether the connection is open.
  order(command, values) {
    if (["move_tip", "open", "close", "stop", "recover"].includes(command)) this.wanted = null;
    const sent = this.send({ command, ...values });
    if (command === "stop") {
      this.stopping = true;
      if (!sent) this.warn();
      else setTimeout(() => this.stopping && this.warn(), STOP_ANSWER_MS);
    }
    return sent;
  }

  /// Repeats an unanswered stop as soon as the page knows that it may stop this hand.
  connected(hand) {
    if (this.stopping && hand.control) this.order("stop");
    this.stopping &&= hand.control;
  }

  disconnected() {
    // The server ends the pushes of a page whose connection ends.
    releaseAll();
    if (this.stopping) this.warn();
  }

  warn() {
    this.open(true);
    if (!this.message) return;
    clearTimeout(this.forget);
    this.message.textContent =
      "sun2xp has NOT confirmed the stop: the hand may still move. Use the emergency stop of the hand. If the page " +
      "has no connection, it sends the stop again when it is connected.";
    this.message.className = "message refused";
  }

  answer({ command, done, text }) {
    if (text === STOPPED) this.stopping = false;
    if (!done) this.wanted = null;
    const push = command.command === "push" ? command.force : null;
    // A push that was refused does not act, so its button does not stay pressed.
    if (push && !done) releaseAll();
    if (!this.message || this.stopping) return;
    // After a refused push, the page sends a push of 0. Its answer must not hide why the first push was refused.
    const refusal = this.message.classList.contains("refused") && this.message.textContent;
    if (refusal && done && push?.every((part) => part === 0)) return;
    this.message.textContent = text;
    this.message.className = done ? "message" : "message refused";
    clearTimeout(this.forget);
    this.forget = setTimeout(() => (this.message.textContent = ""), MESSAGE_MS);
  }
}
