// Power against time, counted three ways.
import { block, figure } from "../dom.js";
import { line } from "../colours.js";
import { isNumber, scale, withError } from "../numbers.js";
import { lines } from "../plots/lines.js";
import { range, roundRange } from "../plots/axes.js";

/** Loss per time between neighbouring rows. */
function lossRate(time, lost) {
  const points = [];
  for (let index = 1; index < time.length; index++) {
    const step = time[index] - time[index - 1];
    if (step > 0 && isNumber(lost[index]) && isNumber(lost[index - 1])) points.push([(time[index] + time[index - 1]) / 2, (lost[index] - lost[index - 1]) / step]);
  }
  return points;
}

const share = (values, part) => {
  const sorted = values.filter(isNumber).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] : NaN;
};

export function powerChart({ series, summary }, key) {
  const time = series?.time_s ?? [];
  if (time.length < 2) return null;
  const pair = (name) => (series[name] ? time.map((t, index) => [t, series[name][index]]).filter((point) => isNumber(point[1])) : []);
  const curves = [["by the torque", "torque", pair("power_torque_W"), 0.8], ["by the charge's place", "com", pair("power_com_W"), 2],
    ["by the losses", "dissipation", series.dissipated_J ? lossRate(time, series.dissipated_J) : [], 1.2]].filter((curve) => curve[2].length > 1);
  if (curves.length === 0) return null;
  const window = summary?.window_s;
  const later = (points) => points.filter(([t]) => t >= (window ? window[0] : time[0] + 0.1 * (time[time.length - 1] - time[0]))).map((point) => point[1]);
  const settled = curves.flatMap((curve) => {
    const values = later(curve[2]);
    return [share(values, 0.01), share(values, 0.99)];
  });
  const by = scale("W", settled);
  const [low, high] = roundRange(range([0, ...settled.map((value) => value * by.factor)], 0.06));
  const drawn = curves.map(([name, , points, width], index) => ({ name, points: points.map(([t, p]) => [t, p * by.factor]), width, colour: line(index), faint: index !== 1 }));
  for (const [index, [name, id]] of curves.entries()) {
    const [mean, error] = [summary?.power_W?.[id], summary?.power_W?.[`${id}_sem`]];
    if (!window || !isNumber(mean)) continue;
    const ends = window.map((t) => [t, mean * by.factor]);
    drawn.push({ name: `${name}, mean`, unlisted: true, points: ends, width: 2.6, colour: line(index),
      band: isNumber(error) ? window.map((t) => [t, (mean - error) * by.factor, (mean + error) * by.factor]) : null });
  }
  const told = curves.map(([name, id]) => (summary?.power_W ? `${name} ${withError(summary.power_W[id], summary.power_W[`${id}_sem`], "W")}` : name)).join("; ");
  return block(`${key}-power`, "Power against time", figure(
    `Power given to the charge, counted three independent ways${window ? "; thick: mean of the analysis window with its standard error" : ""}. In a steady mill the three agree. `
    + "Single impacts reach beyond the frame.",
    lines(`${key}-power`, { label: `Power against time: ${told}`, series: drawn, x: { name: "time", unit: "s", min: time[0], max: time[time.length - 1] },
      y: { name: "power", unit: by.unit, min: low, max: high }, height: (width) => (width < 480 ? 330 : 360),
      marks: window ? [{ x: window[0], text: "analysis window" }] : [] })));
}
