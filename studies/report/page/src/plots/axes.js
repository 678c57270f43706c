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

/** Ends that are not round get no label; nothing: as the library likes. */
const isRound = (end) => (end === undefined || end === Number(end.toPrecision(2)) ? undefined : false);

/** An axis with numbers: {name, unit, log, min, max}; room: px along the axis. */
export function axis(which, { name, unit, log, min, max, splits, gap }, { colours, narrow }, room, more = {}) {
  const vertical = which === "y";
  const lines = broken(named(name, unit), room ?? Infinity);
  return {
    type: log ? "log" : "value", name: lines.join("\n"), nameLocation: "middle", nameGap: vertical ? (gap ?? (narrow ? 42 : 48)) : 28,
    min: log ? decade(min, Math.floor) : min, max: log ? decade(max, Math.ceil) : max,
    nameTextStyle: { color: colours.text, fontSize: 12, lineHeight: 14, verticalAlign: vertical ? "bottom" : "top" }, scale: true, splitNumber: splits ?? (narrow && !vertical ? 4 : 6), logBase: 10,
    axisLine: { show: true, onZero: false, lineStyle: { color: colours.faint } }, axisTick: { show: true, lineStyle: { color: colours.faint } },
    axisLabel: { color: colours.text, fontSize: 11, formatter: (value) => tick(value, log), hideOverlap: true, showMinLabel: isRound(min), showMaxLabel: isRound(max) },
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

const STEPS = [1, 2, 2.5, 5, 10];
/** [low, high] widened to a multiple of a round step. */
export function roundRange([low, high], parts = 6) {
  const rough = (high - low) / parts;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = STEPS.find((one) => one * size >= rough * 0.999) * size;
  const tidy = (value) => Number(value.toPrecision(10));
  return [tidy(Math.floor(low / step) * step), tidy(Math.ceil(high / step) * step)];
}
