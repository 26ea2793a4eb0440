// The samples of the last minute, finger by finger, and the clock that says which of them are shown.

const SECONDS = 60;
const RATE = 60;
/// Batches arrive 20 times a second. The picture is this much behind the newest sample, s, so that it moves evenly.
const DELAY = 0.09;

/// The samples of one finger in a ring. A sample is a row of numbers; `columns` names them.
export class Samples {
  constructor(columns) {
    this.columns = Object.fromEntries(columns.map((name, index) => [name, index]));
    this.width = columns.length;
    this.capacity = (SECONDS * RATE * 1.2) | 0;
    this.values = new Float64Array(this.capacity * this.width);
    this.written = 0;
  }

  get count() {
    return Math.min(this.written, this.capacity);
  }

  push(row) {
    this.values.set(
      row.map((value) => value ?? NaN),
      (this.written % this.capacity) * this.width,
    );
    this.written += 1;
  }

  /// Returns a value. `age` 0 is the newest sample.
  at(age, column) {
    const place = (this.written - 1 - age) % this.capacity;
    return this.values[place * this.width + column];
  }

  /// Returns the age of the newest sample that is not newer than `time`, or of the oldest sample if all are newer.
  ageAt(time) {
    let [low, high] = [0, this.count - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.at(middle, 0) > time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /// Returns the values of the columns at `time`, by linear interpolation between two samples.
  between(time, columns) {
    if (!this.count) return null;
    const age = this.ageAt(time);
    const from = this.at(age, 0);
    const to = age > 0 ? this.at(age - 1, 0) : from;
    const share = to > from ? Math.min(Math.max((time - from) / (to - from), 0), 1) : 0;
    return columns.map((column) => {
      const value = this.at(age, column);
      return share ? value + share * (this.at(age - 1, column) - value) : value;
    });
  }

  /// Returns the columns from `begin` to `end`, s, as arrays.
  window(begin, end, columns) {
    const newest = this.count ? this.ageAt(end) : 0;
    const oldest = this.count ? this.ageAt(begin) : -1;
    const length = Math.max(oldest - newest + 1, 0);
    return columns.map((column) => {
      const values = new Array(length);
      for (let index = 0; index < length; index += 1) values[index] = this.at(oldest - index, column);
      return values;
    });
  }
}

/// Maps the time of the page to the clock of the hand.
export class Clock {
  constructor() {
    this.offset = null;
    this.newest = 0;
    this.frozenAt = null;
  }

  /// Notes the time of the newest sample.
  note(time) {
    const offset = performance.now() / 1000 - time;
    // A late batch must not delay the picture permanently. So a batch raises the offset by at most 0.5 ms. In this
    // way the offset still follows a clock that drifts.
    const jumped = this.offset === null || Math.abs(offset - this.offset) > 2;
    this.offset = jumped ? offset : Math.min(this.offset + 0.0005, offset);
    this.newest = Math.max(jumped ? 0 : this.newest, time);
  }

  get frozen() {
    return this.frozenAt !== null;
  }

  freeze(frozen) {
    this.frozenAt = frozen ? this.live : null;
  }

  get live() {
    if (this.offset === null) return 0;
    return Math.min(performance.now() / 1000 - this.offset - DELAY, this.newest);
  }

  /// The time that the page shows.
  get shown() {
    return this.frozenAt ?? this.live;
  }
}
