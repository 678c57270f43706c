// What differs between two analyses.
import { base64 } from "../base64.js";
import { block, disclosure, element, figure, list, note, table } from "../dom.js";
import { capital, interval, isNumber, number, probability, quantity, readable, scale, signed, words } from "../numbers.js";
import { intervals } from "../plots/intervals.js";

const FIRST = 25; // rows at once
const CHARTED = 15;
const PICTURED = 2;
const VERDICTS = { differ: "they differ", no_difference: "no difference", cannot_tell: "cannot tell" };

const title = (row) => words(row.name.replace(".", ": "));

function ranked(rows, caption) {
  const by = (row) => scale(row.unit, [row.strongest?.a, row.strongest?.b]);
  const value = (name) => (row) => number((row.strongest?.[name] ?? NaN) * by(row).factor);
  return table({ caption, rows, classOf: (row) => (row.differs ? "strong" : null), columns: [
    { label: "rank", number: true, value: (row) => `${row.rank}${row.differs ? " *" : ""}` }, { label: "observable", header: true, wide: true, value: title },
    { label: "A", number: true, value: value("a") }, { label: "B", number: true, value: value("b") },
    { label: "B − A", number: true, value: (row) => signed((row.strongest?.difference ?? NaN) * by(row).factor, 3) },
    { label: "90 % interval", number: true, value: (row) => interval(row.strongest?.low, row.strongest?.high, by(row).factor) }, { label: "unit", value: (row) => by(row).unit },
    { label: "p adjusted", number: true, value: (row) => probability(row.adjusted_p) }, { label: "where", wide: true, value: (row) => row.strongest?.where ?? "" }] });
}

/** A drawn SVG as a picture: nothing inside it can run or ask for anything. */
const picture = ({ name, svg }) => figure(capital(title({ name })), element("div", { class: "picture" },
  element("img", { src: `data:image/svg+xml;base64,${base64(svg)}`, alt: `${title({ name })}: A, B and their difference`, decoding: "async" })));

const side = (name, one) => one && [name, one.name, [one.description, isNumber(one.omega_rad_s) ? `${quantity(Math.abs(one.omega_rad_s), "rad/s")} ${one.omega_rad_s > 0 ? "counter-clockwise" : "clockwise"}` : null,
  `${number(one.blocks)} blocks`].filter(Boolean).join("; ")];

export function comparison(section, key) {
  const { comparison: found, pictures = [] } = section;
  const rows = (found.observables ?? []).map((row, index) => ({ ...row, rank: index + 1 }));
  const differing = rows.filter((row) => row.differs).length;
  const charted = rows.filter((row) => row.strongest?.error > 0).slice(0, CHARTED);
  const values = charted.map(({ strongest, differs }) => ({ value: strongest.difference / strongest.error, low: strongest.low / strongest.error, high: strongest.high / strongest.error, hollow: !differs,
    text: `${signed(strongest.difference / strongest.error, 3)} standard errors` }));
  const given = found.given_quantities_that_differ ?? [];
  const first = pictures.slice(0, PICTURED);
  return {
    kind: "Comparison", sentence: capital(readable(found.sentence)), headline: [["Verdict", VERDICTS[found.verdict] ?? words(found.verdict ?? ""), `at ${number(100 * found.level)} % for all together`],
      ["Observables that differ", `${differing} of ${rows.length}`, null], side("A", found.a), side("B", found.b)],
    blocks: [
      charted.length ? block(`${key}-strongest`, "The strongest differences", figure("The strongest element of each observable: B less A in standard errors, with 90 % intervals. "
        + "Filled: differs, with one error rate for everything; hollow: may be chance.", intervals(`${key}-strongest`, {
        label: charted.slice(0, 4).map((row, index) => `${title(row)} ${signed(values[index].value, 2)} standard errors`).join(", "), rows: charted.map((row) => `${row.rank}. ${title(row)}`),
        groups: [{ name: "", values }], x: { name: "B − A in standard errors" }, zero: 0 }))) : null,
      rows.length ? block(`${key}-ranked`, "All observables, ranked", ranked(rows.slice(0, FIRST), "A star marks what differs; all differences are B less A"),
        rows.length > FIRST ? disclosure(`${key}-rest`, `The other ${rows.length - FIRST} observables`, () => ranked(rows.slice(FIRST), "The other observables")) : null) : null,
      pictures.length ? block(`${key}-pictures`, "Pictures", note("A, B and B − A side by side; what differs is framed."), element("div", { class: "halves" }, first.map(picture)),
        pictures.length > PICTURED ? disclosure(`${key}-more`, `The other ${pictures.length - PICTURED} pictures`, () => element("div", { class: "halves" }, pictures.slice(PICTURED).map(picture))) : null) : null,
      found.notes?.length || given.length || found.not_judged?.length ? block(`${key}-notes`, "Notes of the comparison", found.notes?.length ? list(found.notes) : null,
        given.length ? disclosure(`${key}-given`, `Given quantities that differ (${given.length})`, () => list(given.map((one) => (typeof one === "string" ? one : Object.values(one).join(" "))))) : null,
        found.not_judged?.length ? disclosure(`${key}-not-judged`, `Not judged (${found.not_judged.length})`, () => list(found.not_judged)) : null) : null,
    ],
  };
}
