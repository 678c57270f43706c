// What all charts share: axes with name and unit, numbers at ticks.
import { named, number, superscript } from "../numbers.js";

/** 0.00001 → "10⁻⁵" on logarithmic axes, short numbers elsewhere. */
export const tick = (value, log = false) => {
  const power = Math.log10(Math.abs(value));
  if (value !== 0 && (power > (log ? 2.5 : 5) || power < (log ? -1.5 : -3.5)) && Math.abs(power - Math.round(power)) < 1e-9)
    return `${value < 0 ? "−" : ""}10${superscript(Math.round(power))}`;
  return number(value, 4);
};

const LETTER = 6.4; // px: an average letter of an axis' name

/** A long name in as many lines as it needs beside its axis. */
function broken(text, room) {
  const lines = [""];
  for (const word of text.split(" ")) {
    const last = lines.length - 1;
    if (lines[last] !== "" && (lines[last].length + 1 + word.length) * LETTER > room) lines.push(word);
    else lines[last] += (lines[last] === "" ? "" : " ") + word;
  }
  return lines;
}

/** px that a horizontal axis needs below the plot. */
export const roomBelow = ({ name, unit }, room) => 32 + 14 * broken(named(name, unit), room).length;

const decade = (value, round) => (value > 0 ? 10 ** round(Math.log10(value) + (round === Math.floor ? 1e-9 : -1e-9)) : undefined);

const STEPS = [1, 2, 2.5, 5, 10];
/** A round step that is at least as long. */
const roundStep = (rough) => {
  const size = 10 ** Math.floor(Math.log10(rough));
  return STEPS.find((one) => one * size >= rough * 0.999) * size;
};

const isMultiple = (value, step) => Math.abs(value / step - Math.round(value / step)) < 1e-6;

/** The library counts ticks of a given step from the lower end; where that is not round, it finds its own between the ends. */
function stepOf({ log, low, high }, parts) {
  if (!(high > low) || (log && !(low > 0))) return undefined;
  if (log) return Math.max(1, Math.ceil(Math.log10(high / low) / parts - 1e-9)); // decades
  const step = roundStep((high - low) / parts);
  return isMultiple(low, step) ? step : undefined;
}

/** An axis with numbers: {name, unit, log, min, max}; room: px along the axis. */
export function axis(which, { name, unit, log, min, max, splits, gap }, { colours, narrow }, room, more = {}) {
  const vertical = which === "y";
  const lines = broken(named(name, unit), room ?? Infinity);
  const parts = splits ?? (narrow && !vertical ? 4 : 6);
  const [low, high] = log ? [decade(min, Math.floor), decade(max, Math.ceil)] : [min, max];
  const step = stepOf({ log, low, high }, parts);
  const isEnd = (value) => [low, high].some((end) => Math.abs(value - end) < 1e-6 * (high - low));
  const isUnround = (value) => !log && isEnd(value) && (step === undefined || !isMultiple(value, step)); // its label would stand too near to its neighbour's
  return {
    type: log ? "log" : "value", name: lines.join("\n"), nameLocation: "middle", nameGap: vertical ? (gap ?? (narrow ? 42 : 48)) : 28,
    min: low, max: high,
    nameTextStyle: { color: colours.text, fontSize: 12, lineHeight: 14, verticalAlign: vertical ? "bottom" : "top" }, scale: true, splitNumber: parts, interval: step, logBase: 10,
    axisLine: { show: true, onZero: false, lineStyle: { color: colours.faint } }, axisTick: { show: true, lineStyle: { color: colours.faint } },
    axisLabel: { color: colours.text, fontSize: 11, formatter: (value) => (isUnround(value) ? "" : tick(value, log)), hideOverlap: true },
    splitLine: { show: true, lineStyle: { color: colours.rule, width: 1 } }, minorTick: { show: false }, ...more,
  };
}

/** px that the numbers beside a vertical axis from low to high need. */
export function widthOfTicks(low, high, log) {
  if (log || !(high > low)) return 34;
  const [from, to] = roundRange([low, high]);
  const texts = [tick(from), tick(to), ...[...Array(7).keys()].map((part) => tick(Number((from + ((to - from) * part) / 6).toPrecision(3))))];
  return 12 + 6.3 * Math.min(9, Math.max(...texts.map((text) => text.length)));
}

export const legend = (names, { colours, narrow }) => ({
  show: names.length > 1, data: names, top: 0, left: 0, right: 0, type: "plain", itemWidth: 18, itemHeight: 9, itemGap: narrow ? 8 : 14, icon: "roundRect",
  textStyle: { color: colours.text, fontSize: 12 }, orient: "horizontal", inactiveColor: colours.rule, selectedMode: false,
});

/** Lines that a legend of these names needs at this width, by the length of its texts. */
export function legendHeight(names, width) {
  if (names.length < 2) return 12;
  let lines = 1;
  let used = 0;
  for (const name of names) {
    const wide = 38 + 6.6 * name.length;
    if (used > 0 && used + wide > width) {
      lines += 1;
      used = 0;
    }
    used += wide;
  }
  return 12 + 22 * lines;
}

/** Round ends a little beyond all values. */
export function range(values, share = 0.04) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return [0, 1];
  const beyond = (high - low || Math.abs(high) || 1) * share;
  return [low >= 0 && low < beyond ? 0 : low - beyond, high <= 0 && -high < beyond ? 0 : high + beyond]; // amounts begin at zero, not below it
}

/** [low, high] widened to a multiple of a round step. */
export function roundRange([low, high], parts = 6) {
  const step = roundStep((high - low) / parts);
  const tidy = (value) => Number(value.toPrecision(10));
  return [tidy(Math.floor(low / step) * step), tidy(Math.ceil(high / step) * step)];
}
