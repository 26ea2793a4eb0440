// The time line of events: a row for each finger, and the newest events as text.

import { colour, onColours } from "./theme.js";

const SECONDS = 60;
const LEFT = 78;
const BOTTOM = 18;
const TOP = 8;
const NEAR_PX = 8;
const LISTED = 60;
const KEPT = 2000;

export class Timeline {
  constructor(canvas, tip, list) {
    Object.assign(this, { canvas, tip, list, events: [], fingers: [], last: 0, drawn: [] });
    this.context = canvas.getContext("2d");
    canvas.addEventListener("mousemove", (event) => this.point(event));
    canvas.addEventListener("mouseleave", () => (this.tip.hidden = true));
    onColours(() => this.readColours());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  readColours() {
    const names = ["quiet", "rule", "text", "fault", "warning", "event", "finger-1", "finger-2", "finger-3"];
    this.colours = Object.fromEntries(names.map((name) => [name, colour(name)]));
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    Object.assign(this.canvas, { width: width * devicePixelRatio, height: height * devicePixelRatio });
  }

  /// Starts again for another hand.
  begin(fingers) {
    Object.assign(this, { fingers, events: [], last: 0 });
    this.list.replaceChildren();
  }

  /// Adds events. Events that are already here are ignored, because the server repeats events after a gap.
  add(events) {
    for (const event of events) {
      if (event.number <= this.last) continue;
      this.last = event.number;
      this.events.push(event);
      this.list.prepend(entry(event));
    }
    while (this.list.childElementCount > LISTED) this.list.lastElementChild.remove();
    if (this.events.length > KEPT) this.events.splice(0, this.events.length - KEPT);
  }

  draw(now) {
    const { context, canvas, colours } = this;
    const ratio = devicePixelRatio;
    const [width, height] = [canvas.width / ratio, canvas.height / ratio];
    if (width < LEFT + 40) return;
    const rows = Math.max(this.fingers.length, 1);
    const x = (time) => LEFT + (width - LEFT - 12) * (1 - (now - time) / SECONDS);
    const y = (finger) => TOP + ((height - TOP - BOTTOM) * (this.fingers.indexOf(finger) + 0.5)) / rows;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui, sans-serif";
    this.drawTimes(now, x, height);
    for (const finger of this.fingers) this.drawRow(finger, y(finger), width);
    this.drawn = [];
    for (const event of this.events) {
      if (event.time < now - SECONDS || event.time > now) continue;
      const place = { event, x: x(event.time), y: y(event.finger) };
      this.drawn.push(place);
      this.drawMark(place);
    }
    context.fillStyle = colours.text;
  }

  drawTimes(now, x, height) {
    const { context, colours } = this;
    context.textAlign = "center";
    for (let ago = 0; ago <= SECONDS; ago += 10) {
      const at = Math.round(x(now - ago)) + 0.5;
      context.strokeStyle = colours.rule;
      context.beginPath();
      context.moveTo(at, TOP - 4);
      context.lineTo(at, height - BOTTOM);
      context.stroke();
      context.fillStyle = colours.quiet;
      context.textAlign = ago === 0 ? "right" : "center";
      context.fillText(ago === 0 ? "now" : `−${ago} s`, ago === 0 ? at + 8 : at, height - 5);
    }
  }

  drawRow(finger, y, width) {
    const { context, colours } = this;
    context.strokeStyle = colours.rule;
    context.beginPath();
    context.moveTo(LEFT, Math.round(y) + 0.5);
    context.lineTo(width - 12, Math.round(y) + 0.5);
    context.stroke();
    context.fillStyle = colours[`finger-${finger}`];
    context.beginPath();
    context.arc(14, y, 4, 0, 7);
    context.fill();
    context.fillStyle = colours.quiet;
    context.textAlign = "left";
    context.fillText(`finger ${finger}`, 23, y + 4);
  }

  drawMark({ event, x, y }) {
    const { context, colours } = this;
    context.fillStyle = colours[event.severity];
    context.beginPath();
    if (event.severity === "event") context.arc(x, y, 3.5, 0, 7);
    else {
      const size = event.severity === "fault" ? 7 : 6;
      context.moveTo(x, y - size);
      context.lineTo(x + size, y + size * 0.8);
      context.lineTo(x - size, y + size * 0.8);
    }
    context.fill();
  }

  point({ offsetX, offsetY }) {
    const near = this.drawn.filter((place) => Math.hypot(place.x - offsetX, place.y - offsetY) < NEAR_PX).slice(-6);
    this.tip.hidden = !near.length;
    if (!near.length) return;
    this.tip.replaceChildren(...near.map(({ event }) => entry(event)));
    const right = offsetX > this.canvas.clientWidth / 2;
    Object.assign(
      this.tip.style,
      right
        ? { right: `${this.canvas.clientWidth - offsetX + 10}px`, left: "auto" }
        : { left: `${offsetX + 10}px`, right: "auto" },
    );
  }
}

function entry(event) {
  const line = document.createElement("li");
  line.className = event.severity;
  const time = document.createElement("time");
  const wall = new Date(event.wall * 1000);
  time.textContent = `${wall.toTimeString().slice(0, 8)}.${String(wall.getMilliseconds()).padStart(3, "0")}`;
  const finger = document.createElement("b");
  finger.dataset.finger = event.finger;
  finger.textContent = event.finger;
  const text = document.createElement("span");
  text.textContent = event.name;
  line.title = event.text;
  line.append(time, finger, text);
  return line;
}
