// The quadratic surface of a calibration: contours, the same to be turned in 3-D, coefficients and what the fit is worth.
import { block, element, figure, list, note, paragraph, table } from "../dom.js";
import { capital, interval, isNumber, number, percent, probability, words } from "../numbers.js";
import { colouring } from "../colours.js";
import { colourBar } from "../plots/map.js";
import { levels, plane } from "../plots/plane.js";
import { Surface } from "../three/surface.js";

const CELLS = 51; // odd, so that the design's centre is one of the places
const REACH = 1.6; // coded units to each side: a little beyond the axial points of a central composite design in two factors

/** The surface's value at coded places by name: {a: 0.5, b: −1}. Terms are "1", "a", "a^2", "a*b". */
export function valueAt(coefficients, coded) {
  return coefficients.reduce((sum, { name, value }) => sum + value * (name === "1" ? 1 : name.split("*").reduce((product, part) => {
    const [factor, power] = part.split("^");
    return product * coded[factor] ** Number(power ?? 1);
  }, 1)), 0);
}

function fieldOf({ factors, coefficients, stationary }, across, up, objective) {
  const rest = {};
  factors.forEach((factor, index) => {
    const natural = stationary?.inside ? stationary.natural[index] : factor.centre;
    rest[factor.name] = (natural - factor.centre) / factor.step;
  });
  const coded = [...Array(CELLS).keys()].map((index) => -REACH + (2 * REACH * index) / (CELLS - 1));
  const places = (factor) => coded.map((one) => factor.centre + one * factor.step);
  const values = coded.flatMap((vertical) => coded.map((horizontal) => valueAt(coefficients, { ...rest, [across.name]: horizontal, [up.name]: vertical })));
  return { xs: places(across), ys: places(up), values, levels: levels(Math.min(...values), Math.max(...values)), name: objective };
}

const surfaces = new Map();
const choices = new Map();

function drawing(section, key) {
  const { surface, objective } = section.calibration;
  const { factors } = surface;
  const holder = element("div");
  const names = factors.map((factor) => factor.name);
  const chosen = choices.get(key) ?? [0, 1];
  const draw = () => {
    const [across, up] = choices.get(key) ?? chosen;
    const [a, b] = [factors[across], factors[up]];
    const field = fieldOf(surface, a, b, `objective (${objective})`);
    const scale = colouring(field.values, { signed: false });
    const ends = (factor, places) => ({ name: words(factor.name), min: places[0], max: places[CELLS - 1] });
    const [x, y] = [ends(a, field.xs), ends(b, field.ys)];
    const { columns = [], rows = [] } = section.runs ?? {};
    const column = (name) => columns.indexOf(name);
    const points = rows.filter((row) => isNumber(row[column("objective")])).map((row) => ({ x: row[column(a.name)], y: row[column(b.name)], value: row[column("objective")],
      text: [["simulation", number(row[column("number")])], ["stage", row[column("stage")]], ["objective", number(row[column("objective")], 3)]] }))
      .filter((point) => point.x >= x.min && point.x <= x.max && point.y >= y.min && point.y <= y.max);
    const groups = [{ name: "simulated", points }];
    if (surface.stationary?.inside)
      groups.push({ name: surface.stationary.kind, symbol: "diamond", size: 16, fill: "#d55e00", points: [{ x: surface.stationary.natural[across], y: surface.stationary.natural[up],
        text: [["value", number(surface.stationary.value, 3)]] }] });
    const flat = plane(`${key}-contour`, { label: `Contours of the surface over ${x.name} and ${y.name}`, x, y, field, colour: scale ? scale.colour : () => "transparent", groups, height: 400 });
    if (!surfaces.has(key)) surfaces.set(key, new Surface(`The quadratic surface over ${words(a.name)} and ${words(b.name)}`));
    const turned = surfaces.get(key);
    if (turned.works) turned.show({ x, y, field });
    holder.replaceChildren(element("div", { class: "halves" },
      figure("Contours of the quadratic surface, with the simulated sets in the colours of what they gave: where a point stands out from its ground, the surface misses it.", flat,
        colourBar(scale, { name: "objective" })),
      turned.works ? figure("The same surface. Drag it or use the arrow keys to turn it.", turned.element)
        : element("p", { class: "missing" }, "This browser shows no 3-D (WebGL 2 is missing or switched off); the contours show the same surface.")));
  };
  draw();
  const select = (position) => element("select", { "aria-label": position === 0 ? "Parameter to the right" : "Parameter upwards", change: (event) => {
    const next = [...(choices.get(key) ?? chosen)];
    next[position] = Number(event.target.value);
    if (next[0] === next[1]) next[1 - position] = (next[position] + 1) % names.length;
    choices.set(key, next);
    chooser.querySelectorAll("select").forEach((one, index) => (one.value = next[index]));
    draw();
  } }, names.map((name, index) => element("option", { value: index, selected: index === chosen[position] }, words(name))));
  const chooser = element("div", { class: "chooser" }, "To the right:", select(0), "upwards:", select(1), element("small", null, "The others stay at the stationary point, or at the design's centre."));
  return names.length > 2 ? [chooser, holder] : holder;
}

const square = (name, sum) => (sum ? { name, ...sum } : null);

export function surfaceBlock(section, key) {
  const { surface } = section.calibration;
  if (!surface) return null;
  const { stationary } = surface;
  const region = stationary?.region;
  const checks = [square("lack of fit", surface.lack_of_fit), square("pure error", surface.pure_error)].filter(Boolean);
  return block(`${key}-surface`, "Response surface", stationary?.sentence ? paragraph(`The surface has ${stationary.sentence}.`) : null,
    surface.lack_of_fit_means ? paragraph(`${capital(surface.lack_of_fit_means)}.`) : null, surface.factors.length >= 2 ? drawing(section, `${key}-surface`) : null,
    stationary ? table({ caption: `The ${stationary.kind} of the surface${region ? ` with its ${percent(region.confidence, 3)} confidence region (Box & Hunter 1954)` : ""}`,
      rows: surface.factors.map((factor, index) => ({ ...factor, at: stationary.natural[index], low: region?.low?.[index], high: region?.high?.[index] })),
      columns: [{ label: "parameter", value: (row) => words(row.name) }, { label: "value", number: true, value: (row) => number(row.at) },
        { label: "region", number: true, value: (row) => interval(row.low, row.high) }, { label: "centre of the design", number: true, value: (row) => number(row.centre) },
        { label: "step", number: true, value: (row) => number(row.step) }] }) : null,
    table({ caption: `Coefficients in coded units (natural = centre + step × coded); R² = ${number(surface.r_squared, 3)}`, rows: surface.coefficients, columns: [{ label: "term", value: (row) => words(row.name).replace("^2", "²").replace("*", " × ") },
      { label: "value", number: true, value: (row) => number(row.value, 3) }, { label: "standard error", number: true, value: (row) => number(row.standard_error, 2) },
      { label: "F", number: true, value: (row) => number(row.F, 3) }, { label: "p", number: true, value: (row) => probability(row.p) }] }),
    checks.length ? table({ caption: "How well the surface fits", rows: checks, columns: [{ label: "", value: (row) => row.name }, { label: "sum of squares", number: true, value: (row) => number(row.sum) },
      { label: "degrees of freedom", number: true, value: (row) => number(row.df) }, { label: "F", number: true, value: (row) => number(row.F, 3) }, { label: "p", number: true, value: (row) => probability(row.p) }] }) : null,
    surface.notes?.length ? list(surface.notes) : null, surface.factors.length < 2 ? note("One factor alone was kept: there is no surface to draw.") : null);
}
