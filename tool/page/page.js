// The page of `sun2xp monitor --web`: connects the stream, the 3-D view, the panel, the plots and the time line.

import { Vector3 } from "./vendor/three.js";
import { CM_PER_NEWTON } from "./arrow.js";
import { Control } from "./control.js";
import { showFaults } from "./faults.js";
import { ELLIPSOID_NEWTON } from "./finger3d.js";
import { Hand3d } from "./hand3d.js";
import { Labels } from "./labels.js";
import { Object3d } from "./object3d.js";
import { Panel } from "./panel.js";
import { Plots } from "./plots.js";
import { View } from "./scene.js";
import { Clock, Samples } from "./store.js";
import { Stream } from "./stream.js";
import { Timeline } from "./timeline.js";

const TEXT_MS = 100;
const PLOT_MS = 66;
/// The z coordinate, in the palm's frame, at which the floor crosses the z axis, cm. FLOOR_CM is for a hand whose
/// fingers point up, and TOP_CM is for a hand whose fingers point down.
const FLOOR_CM = -6.7;
const TOP_CM = 15.5;
const nothingReceived = () => ({ number: 0, lost: 0, cycles: 0, skipped: 0 });
const byId = (id) => document.getElementById(id);

const view = new View(byId("hand3d"));
const labels = new Labels(byId("labels"), view);
const panel = new Panel(byId("fingers"), byId("detail"), select);
const plots = new Plots(byId("plots"), point);
const timeline = new Timeline(byId("timeline"), byId("tip"), byId("events"));
let clock = new Clock();
let hand = null;
let drawn = null;
let object = null;
let objectState = null;
let samples = new Map();
let states = new Map();
let statuses = new Map();
let selected = 1;
let pointedTime = null;
let received = nothingReceived();
let linked = { socket: false, hand: false, reason: "" };

const stream = new Stream({
  link(connected, reason) {
    linked = { socket: connected, hand: connected && linked.hand, reason };
    if (!connected) control.disconnected();
  },
  hand: begin,
  gone({ reason }) {
    linked.hand = false;
    linked.reason = reason;
  },
  batch,
  state({ finger, ...state }) {
    states.set(finger, state);
  },
  status({ finger, ...status }) {
    statuses.set(finger, status);
  },
  events({ events }) {
    timeline.add(events);
  },
  answer(message) {
    control.answer(message);
  },
});
const control = new Control(byId("control"), byId("control-toggle"), {
  send: (message) => stream.send(message),
  desired: setPoint,
  opened: (width) => view.setPanel(width),
});

/// Handles the description of a hand: of the first hand, of the same hand after a gap, or of another hand.
function begin(message) {
  linked.hand = true;
  const again = hand && hand.identity === message.identity;
  hand = message;
  control.connected(hand);
  if (again) return;
  samples = new Map(hand.fingers.map((finger) => [finger.number, new Samples(hand.columns)]));
  [states, statuses, clock, received] = [new Map(), new Map(), new Clock(), nothingReceived()];
  setFrozen(false);
  if (!hand.fingers.some((finger) => finger.number === selected)) selected = hand.fingers[0].number;
  buildScene();
  panel.begin(hand.fingers);
  timeline.begin(hand.fingers.map((finger) => finger.number));
  control.begin(hand);
  byId("name").textContent = hand.name;
  byId("freeze").title = `${hand.control ? "" : "Space: "}stop the picture; the hand continues`;
  document.title = `${hand.name} · sun2xp`;
}

function buildScene() {
  if (drawn) view.world.remove(drawn.group);
  if (object) view.world.remove(object.group);
  drawn = new Hand3d(hand.geometry);
  object = hand.geometry.object && new Object3d(hand.geometry.object);
  view.world.add(drawn.group);
  if (object) view.world.add(object.group);
  // Gravity points down in the picture. Without gravity, the fingers point up.
  const up = new Vector3(...hand.geometry.gravity).negate();
  if (up.length() < 1e-6) up.set(0, 0, 1);
  view.world.quaternion.setFromUnitVectors(up.normalize(), new Vector3(0, 0, 1));
  const upright = up.z > -0.5;
  view.setFloor(upright ? FLOOR_CM : -TOP_CM);
  view.frame(new Vector3(0, 0, upright ? 3.6 : -4.2), 11.4);
  labels.begin(drawn);
}

function batch(message) {
  for (const { finger, rows } of message.fingers) {
    const of = samples.get(finger);
    for (const row of rows) of?.push(row);
    if (rows.length) clock.note(rows.at(-1)[0]);
  }
  objectState = message.object;
  countLost(message);
}

/// Counts the cycles that the monitor has lost, and the cycles of the batches that this page was too slow to get.
function countLost({ number, lost, cycles: [own, all] }) {
  if (received.number && number > received.number + 1) received.skipped += all - own - received.cycles;
  Object.assign(received, { number, lost, cycles: all });
}

function select(number) {
  selected = number;
}

/// Returns the joint angles of the set point in force; none for a finger that is not a spring.
function setPoint(number) {
  const of = samples.get(number);
  const joints = of?.count ? ["d0", "d1", "d2"].map((name) => of.at(0, of.columns[name])) : [NaN];
  return joints.some(Number.isNaN) ? null : joints;
}

/// While the page is frozen, the hand is shown as it was at the time under the cursor.
function point(time) {
  pointedTime = clock.frozen ? time : null;
}

function setFrozen(frozen) {
  clock.freeze(frozen);
  pointedTime = null;
  document.body.classList.toggle("frozen", frozen);
  byId("freeze").textContent = frozen ? "Continue" : "Freeze";
}

function showLink() {
  const live = linked.socket && linked.hand;
  const stalled = live && clock.live >= clock.newest && performance.now() / 1000 - clock.offset > clock.newest + 1;
  const stopped = states.size > 0 && [...states.values()].every((state) => state.fault);
  const word = clock.frozen
    ? "frozen"
    : !linked.socket
      ? "reconnecting"
      : !linked.hand
        ? "waiting for a hand"
        : stopped
          ? "stopped"
          : stalled
            ? "no samples"
            : "live";
  byId("link").dataset.state = clock.frozen ? "frozen" : live && !stalled ? "live" : "down";
  byId("link").lastElementChild.textContent = word;
  const notice = byId("notice");
  notice.hidden = live;
  notice.textContent = linked.reason || "Waiting for a hand.";
}

function showTexts() {
  showLink();
  const of = samples.get(selected);
  const cycles = of?.count > 30 ? (of.at(0, 1) - of.at(30, 1)) / (of.at(0, 0) - of.at(30, 0)) : NaN;
  byId("rate").textContent = Number.isFinite(cycles) ? `${Math.round(cycles)} Hz` : "–";
  const lost = received.lost + received.skipped;
  byId("lost").textContent = String(lost);
  byId("lost").classList.toggle("alarming", lost > 0);
  byId("frames").textContent = view.frames.rate ? `${Math.round(view.frames.rate)} fps` : "–";
  showFaults(byId("faults"), states, statuses);
  panel.show(samples, states, statuses, selected, pointedTime ?? clock.shown);
  control.show(selected, states.get(selected));
  timeline.draw(clock.shown);
}

let [texts, plotted, pictures] = [0, 0, 0];
view.run(() => {
  const now = performance.now();
  const shown = pointedTime ?? clock.shown;
  if (drawn?.show(samples, states, shown) && (pictures += 1) === 2) performance.mark("the hand is drawn");
  if (object && !clock.frozen) object.show(objectState);
  labels.show();
  if (now - texts > TEXT_MS) {
    texts = now;
    showTexts();
  }
  const finger = hand?.fingers.find((one) => one.number === selected);
  if (finger && now - plotted > PLOT_MS && !(clock.frozen && plots.time === clock.shown && plots.finger === selected)) {
    plotted = now;
    plots.finger = selected;
    plots.show(samples.get(selected), finger, clock.shown);
  }
});

byId("freeze").addEventListener("click", () => setFrozen(!clock.frozen));
byId("reset-view").addEventListener("click", () => view.reset());

/// Handles the space bar. A browser would also press the button that has the focus, when the key goes down or up.
function space(event) {
  // Without control, the space bar keeps its meaning for buttons.
  if (!hand?.control && event.target.closest("input, select, textarea, button")) return;
  event.preventDefault();
  if (event.type === "keyup") return;
  // As in the terminal, the space bar stops a hand that the page may move, wherever the focus is.
  if (hand?.control) control.order("stop");
  else setFrozen(!clock.frozen);
}

document.addEventListener("keyup", (event) => event.key === " " && space(event));
document.addEventListener("keydown", (event) => {
  if (event.key === " ") space(event);
  else if (samples.has(Number(event.key)) && !event.target.closest("input")) select(Number(event.key));
});
byId("legend-ellipsoid").textContent = `compliance: motion of the tip under ${ELLIPSOID_NEWTON} N`;
byId("legend-arrow").textContent = `tip force, ${CM_PER_NEWTON} cm per N`;
