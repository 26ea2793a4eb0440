// The faults and warnings of the hand, with what to do about them.

import { element } from "./element.js";

/// Shows the faults of all fingers, and the warnings.
export function showFaults(box, states, statuses) {
  const lines = [];
  for (const [number, { fault }] of states) {
    if (fault) lines.push({ kind: "fault", number, ...fault });
  }
  for (const [number, { warnings }] of statuses) {
    for (const warning of warnings ?? []) lines.push({ kind: "warning", number, ...warning });
  }
  const text = JSON.stringify(lines);
  if (box.dataset.shown === text) return;
  box.dataset.shown = text;
  box.replaceChildren(
    ...lines.map((line) =>
      element(
        "p",
        line.kind,
        element("b", "", `Finger ${line.number}: ${line.detail ?? line.name}`),
        " ",
        element("span", "", line.remedy),
      ),
    ),
  );
}
