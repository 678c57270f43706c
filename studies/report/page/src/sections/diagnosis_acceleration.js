// The missing force without a form: how the recorded beads' mean acceleration differs from the retuned base's, by place and by speed.
import { block, disclosure, element, figure, note, table } from "../dom.js";
import { interval, number, probability } from "../numbers.js";
import { lines } from "../plots/lines.js";
import { map } from "../plots/map.js";
import { range, roundRange } from "../plots/axes.js";

const SURE = 0.05;
const MM = 1000;

/** Middle of a cell, in mm. Angles count from 6 o'clock in the turning sense, so that a mill that turns clockwise has them at x < 0. */
function middle(cell, sense) {
  const radius = (cell.r_m[0] + cell.r_m[1]) / 2;
  const angle = ((cell.angle_deg[0] + cell.angle_deg[1]) / 2) * (Math.PI / 180);
  return [sense * radius * Math.sin(angle) * MM, -radius * Math.cos(angle) * MM];
}

const told = (found) => `${number(found.value, 3)} (${interval(found.low90, found.high90)})`;

const cellTable = (cells, caption) => table({ caption, rows: cells, columns: [{ label: "distance from the axis (mm)", value: (cell) => `${number(cell.r_m[0] * MM, 3)} … ${number(cell.r_m[1] * MM, 3)}` },
  { label: "angle from 6 o'clock (°)", number: true, value: (cell) => `${number(cell.angle_deg[0], 3)} … ${number(cell.angle_deg[1], 3)}` },
  { label: "x (m/s², 90 %)", number: true, value: (cell) => told(cell.x_m_per_s2) }, { label: "y (m/s², 90 %)", number: true, value: (cell) => told(cell.y_m_per_s2) },
  { label: "p, all cells together", number: true, value: (cell) => probability(cell.p_value) }] });

function condition(found, key, sense) {
  const { cells } = found;
  const radius = Math.max(...cells.map((cell) => cell.r_m[1])) * MM;
  const sizes = cells.map((cell) => Math.hypot(cell.x_m_per_s2.value, cell.y_m_per_s2.value)).sort((a, b) => a - b);
  const typical = sizes[Math.floor(0.95 * (sizes.length - 1))] || 1;
  const unit = Number((typical / 2).toPrecision(1)) || 1; // m/s² of the arrow that tells the scale
  const perUnit = (0.22 * radius) / typical;
  const limit = 1.5 * typical; // rare longer arrows are cut
  const arrows = cells.map((cell) => {
    const [x, y] = middle(cell, sense);
    const size = Math.hypot(cell.x_m_per_s2.value, cell.y_m_per_s2.value);
    const by = perUnit * Math.min(1, limit / size);
    return { x, y, dx: cell.x_m_per_s2.value * by, dy: cell.y_m_per_s2.value * by, sure: cell.p_value < SURE };
  });
  arrows.push({ x: -1.0 * radius, y: -1.04 * radius, dx: unit * perUnit, dy: 0, sure: false });
  const marks = [{ x: -1.0 * radius + unit * perUnit, y: -1.04 * radius, text: `${number(unit, 1)} m/s²`, hidden: true }];
  const sure = cells.filter((cell) => cell.p_value < SURE).length;
  const reach = { min: -1.1 * radius, max: 1.1 * radius };
  const speeds = found.by_speed ?? [];
  const curve = { name: "", points: speeds.map((one) => [(one.speed_over_shell[0] + one.speed_over_shell[1]) / 2, one.along_motion_m_per_s2.value]), symbols: true,
    band: speeds.map((one) => [(one.speed_over_shell[0] + one.speed_over_shell[1]) / 2, one.along_motion_m_per_s2.low90, one.along_motion_m_per_s2.high90]) };
  const [low, high] = roundRange(range([0, ...curve.band.flatMap((point) => point.slice(1))]), 5);
  return [
    element("h4", null, found.condition),
    element("div", { class: "halves" },
      figure(`${found.condition}: mean acceleration of the recorded beads less that of the retuned base. Strong arrows: ${sure} of ${cells.length} cells, p below ${SURE} for all cells together.`,
        map(`${key}-arrows`, { label: `Missing acceleration in ${cells.length} cells of ${found.condition}; the table has the numbers`, x: { name: "x", unit: "mm", ...reach },
          y: { name: "y", unit: "mm", ...reach }, shell: { radius }, arrows, marks, title: found.condition })),
      speeds.length ? figure(`${found.condition}: the same along the beads' own motion, by their speed, with 90 % bands. Below zero: something brakes that the base lacks.`,
        lines(`${key}-speed`, { label: `Missing acceleration along the motion against speed, ${found.condition}`, series: [curve],
          x: { name: "speed over the shell's speed", min: 0, max: speeds[speeds.length - 1].speed_over_shell[1] },
          y: { name: "acceleration along the motion", unit: "m/s²", min: low, max: high }, height: 330 })) : null),
    cellTable(cells.slice(0, 8), `${found.condition}: the surest cells`),
    cells.length > 8 ? disclosure(`${key}-cells`, `The other ${cells.length - 8} cells of ${found.condition}`, () => cellTable(cells.slice(8), "The other cells")) : null,
  ];
}

/** The turning sense: as the page is told, or the side on which the recorded charge rises; 0 where neither is known. */
function senseOf(turns, held) {
  if (turns) return Math.sign(turns);
  const centre = held.flatMap((one) => one.observables ?? []).find((one) => one.observable === "centre of mass x");
  return Math.sign(centre?.recorded ?? 0);
}

export function missingAcceleration({ missing_acceleration: all = [], held_out: held = [], offered_terms: offered }, key, turns) {
  const sense = senseOf(turns, held);
  const filled = all.filter((one) => one.cells?.length > 0);
  if (filled.length === 0) return null;
  return block(`${key}-acceleration`, "The missing acceleration", note("No form is assumed here: this is what the recorded beads do beyond what the base, retuned, makes them do."
    + (sense === 0 ? " The turning sense is not known here: the mill is drawn as turning counter-clockwise." : "")),
  filled.map((found, index) => condition(found, `${key}-acceleration-${index + 1}`, sense || 1)),
  offered?.sentence ? element("p", { class: "sentence" }, offered.sentence) : null);
}
