// A liner that wears away: its profile at each stage, and what the mill does meanwhile.
import { block, element, figure, list, svg, table } from "../dom.js";
import { colourAt, line, theme } from "../colours.js";
import { isNumber, number, quantity, scale, withError } from "../numbers.js";
import { lines } from "../plots/lines.js";

const RADIANS = Math.PI / 180;
/** Long lives in thousands of hours, so that the numbers of an axis stay short. */
const timeOf = (found) => (found.stages.at(-1).hours >= 10000 ? { factor: 1e-3, unit: "1000 h" } : { factor: 1, unit: "h" });
const hours = (stage) => `${number(stage.hours, 5)}\u00a0h`;

/** Places along the new shell and heights above it, mm, over one pitch and its first place again. */
function profileOf({ angle_deg: angles, stages }, stage) {
  const shell = Math.max(...stages[0].radius_m);
  const step = angles.length > 1 ? angles[1] - angles[0] : 0;
  const at = (index) => 1e3 * shell * RADIANS * step * index;
  return [...stage.radius_m, stage.radius_m[0]].map((radius, index) => [at(index), 1e3 * (shell - radius)]);
}

/** The metal of one stage, with the outline of the new liner; the slider goes through the stages. */
function slider(found, key) {
  const all = found.stages.map((stage) => profileOf(found, stage));
  const wide = all[0].at(-1)[0];
  const heights = all.flatMap((points) => points.map((point) => point[1]));
  const low = Math.min(...heights) - 0.15 * (Math.max(...heights) - Math.min(...heights)), high = Math.max(...heights);
  const frame = `0 ${-1.05 * high} ${wide} ${1.05 * high - low}`;
  const path = (points) => points.map(([x, y], index) => `${index ? "L" : "M"}${x} ${-y}`).join("");
  const metal = svg("path", { fill: "currentColor", "fill-opacity": 0.35, stroke: "none" });
  const fresh = svg("path", { d: path(all[0]), fill: "none", stroke: theme().faint, "stroke-width": 1.5, "stroke-dasharray": "5 4", "vector-effect": "non-scaling-stroke" });
  const drawing = svg("svg", { viewBox: frame, role: "img", width: "100%", style: "max-height:16rem;color:inherit", "aria-label": "Cut across one pitch of the liner" }, metal, fresh);
  const label = element("output", null);
  const input = element("input", { type: "range", min: 0, max: all.length - 1, step: 1, value: all.length - 1, id: `${key}-stage`, style: "width:100%", input: () => show(Number(input.value)) });
  const show = (index) => {
    input.setAttribute("aria-valuetext", hours(found.stages[index]));
    metal.setAttribute("d", `${path(all[index])}L${wide} ${-low}L0 ${-low}Z`);
    label.textContent = `after ${hours(found.stages[index])}: lifters ${quantity(found.stages[index].lifter_height_m, "m", 3)} high (${quantity(found.stages[index].lifter_left_m, "m", 3)} above the new shell), power ${quantity(found.stages[index].power_W, "W", 4)}`;
  };
  show(all.length - 1);
  return element("div", null, drawing, element("label", { for: `${key}-stage` }, "hours "), input, label);
}

const profiles = (found, key) => lines(`${key}-profiles`, {
  label: `Profile of one pitch at ${found.stages.length} times`, x: { name: "along the shell", unit: "mm", min: 0, max: profileOf(found, found.stages[0]).at(-1)[0] }, y: { name: "height above the new shell", unit: "mm" },
  series: found.stages.map((stage, index) => ({ name: hours(stage), points: profileOf(found, stage), colour: colourAt("sequential", 0.15 + (0.75 * index) / Math.max(1, found.stages.length - 1)) })),
});

/** One number of the stages against hours; null where it is not known. */
function course(found, key, { name, title, unit, error }) {
  const known = found.stages.filter((stage) => isNumber(stage[name]));
  if (known.length < 2) return null;
  const by = scale(unit, known.map((stage) => stage[name])), time = timeOf(found);
  const points = known.map((stage) => [time.factor * stage.hours, by.factor * stage[name]]);
  const band = error ? known.map((stage) => [time.factor * stage.hours, by.factor * (stage[name] - (stage[error] ?? 0)), by.factor * (stage[name] + (stage[error] ?? 0))]) : null;
  const values = (band ?? points).flatMap((point) => point.slice(1));
  const spread = Math.max(...values) - Math.min(...values) || Math.abs(values[0]) || 1;
  return figure(title, lines(`${key}-${name}`, { label: `${title} against hours`, series: [{ name: "", points, band, colour: line(0), symbols: true }], x: { name: "time", unit: time.unit },
    y: { name: title.toLowerCase(), unit: by.unit, min: Math.min(...values) - 0.2 * spread, max: Math.max(...values) + 0.2 * spread }, height: 240 }));
}

const COURSES = [{ name: "power_W", title: "Power", unit: "W", error: "power_error_W" }, { name: "mass_lost_kg", title: "Mass lost", unit: "kg" },
  { name: "shoulder_deg", title: "Shoulder", unit: "deg" }, { name: "toe_deg", title: "Toe", unit: "deg" }];

const stages = (found) => table({ caption: "The liner at each stage", rows: found.stages, columns: [{ label: "hours", header: true, number: true, value: (one) => number(one.hours, 5) },
  { label: "height of the lifters", number: true, value: (one) => quantity(one.lifter_height_m, "m", 3) }, { label: "left of them", number: true, value: (one) => quantity(one.lifter_left_m, "m", 3) }, { label: "plate lost", number: true, value: (one) => quantity(one.plate_lost_m, "m", 3) },
  { label: "mass lost", number: true, value: (one) => quantity(one.mass_lost_kg, "kg", 3) }, { label: "volume lost", number: true, value: (one) => `${number(1e6 * one.volume_lost_m3, 3)} ± ${number(1e6 * one.volume_lost_error_m3, 2)}\u00a0cm³` },
  { label: "power", number: true, value: (one) => withError(one.power_W, one.power_error_W, "W") }, { label: "shoulder", number: true, value: (one) => quantity(one.shoulder_deg, "deg", 3) }, { label: "toe", number: true, value: (one) => quantity(one.toe_deg, "deg", 3) }] });

function sentenceOf(found) {
  const [first, last] = [found.stages[0], found.stages.at(-1)];
  const change = isNumber(first.power_W) && first.power_W !== 0 ? `; power goes from ${quantity(first.power_W, "W")} to ${quantity(last.power_W, "W")}` : "";
  const lifters = `the lifters go from ${quantity(first.lifter_height_m, "m", 3)} to ${quantity(last.lifter_height_m, "m", 3)}`;
  return `In ${hours(last)} ${lifters}, and the liner loses ${quantity(last.mass_lost_kg, "kg", 3)}${change}.${found.stopped ? ` It stopped because ${found.stopped}.` : ""}`;
}

export function wear(section, key) {
  const { wear: found } = section;
  const last = found.stages.at(-1);
  return {
    kind: "Wear", sentence: sentenceOf(found),
    headline: [["Liner", found.body, `${number(found.pitches)} pitches, ${number(found.rows)} ${found.rows === 1 ? "row" : "rows"} along the mill`], ["Hours", number(last.hours, 5), `in ${number(found.stages.length - 1)} steps`],
      ["Mass lost", quantity(last.mass_lost_kg, "kg", 3)], ["Plate lost", quantity(last.plate_lost_m, "m", 3), "where it is deepest"]],
    blocks: [
      found.doubts?.length ? block(`${key}-doubts`, "Doubts", list(found.doubts)) : null,
      block(`${key}-away`, "The liner wears away", figure("A cut across one pitch, the metal grey, the new liner dashed; directions grow to the right, so a mill that turns counter-clockwise moves the lifter to the right. Mean over all pitches and the mill's length. Move the slider.", slider(found, key)),
        figure("All stages together.", profiles(found, key))),
      block(`${key}-course`, "What the mill does meanwhile", element("div", { class: "halves" }, COURSES.map((one) => course(found, key, one)))),
      block(`${key}-stages`, "Numbers", stages(found)),
    ],
  };
}
