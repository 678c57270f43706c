// One mill, played by two engines.
import { block, disclosure, element, figure, list, table } from "../dom.js";
import { number, probability, scale, signed, withError } from "../numbers.js";
import { intervals } from "../plots/intervals.js";

const MARKS = { agree: "pass", differ: "fail" };

const said = (row, seeds) => (row.judgement !== "not resolved" ? row.judgement
  : row.seeds_needed > 10 * seeds ? "not resolved: lies at the limit" : `not resolved: ${number(Math.ceil(row.seeds_needed))} seeds would do`);
const mark = (seeds) => (row) => (row.judgement ? element("span", { class: MARKS[row.judgement] ?? null }, said(row, seeds)) : "");
const mean = (row, who) => withError(row[who].value, row[who].error, row.unit);
const limit = (row) => { const by = scale(row.unit, [row.ours.value]); return row.limit ? `${number(by.factor * row.limit, 2)} ${by.unit}` : ""; };

const quantities = (rows, { engine, seeds }, caption) => table({ caption, rows, columns: [{ label: "quantity", wide: true, value: (row) => row.name },
  { label: "millscope", number: true, value: (row) => mean(row, "ours") }, { label: engine, number: true, value: (row) => mean(row, "theirs") },
  { label: "difference", number: true, value: (row) => mean(row, "difference") }, { label: "limit", number: true, value: limit },
  { label: "p, all together", number: true, value: (row) => probability(row.adjusted_p) }, { label: "", value: mark(seeds) }] });

const switched = (all) => table({ caption: "What a setting on millscope's side moves, and what it leaves", groupOf: (row) => row.setting,
  rows: all.flatMap((one) => one.moves.map((moves, index) => ({ setting: one.setting, moves, leaves: one.leaves[index] })).filter((row) => row.moves.limit)),
  columns: [{ label: "quantity", wide: true, value: (row) => row.moves.name }, { label: "moves it by", number: true, value: (row) => mean(row.moves, "difference") },
    { label: "leaves", number: true, value: (row) => mean(row.leaves, "difference") }, { label: "limit", number: true, value: (row) => limit(row.moves) }] });

export function crosscheck(section, key) {
  const { crosscheck: found } = section;
  const rows = found.quantities ?? [];
  const usable = rows.filter((row) => row.difference.error > 0);
  const values = usable.map((row) => {
    const errors = row.difference.value / row.difference.error;
    return { value: errors, low: errors - 1, high: errors + 1, hollow: row.adjusted_p > found.level, text: `${mean(row, "difference")}, ${signed(errors, 2)} standard errors, p ${probability(row.adjusted_p)}` };
  });
  return {
    kind: "Cross-check", sentence: `${found.sentence}.`,
    headline: [["Engines", `millscope and ${found.engine}`, found.engine_version], ["Starts", number(found.seeds), `of ${number(found.window_s)} s each`]],
    blocks: [
      block(`${key}-limits`, "Near enough?", quantities(rows.filter((row) => row.limit), found, "What has a limit")),
      block(`${key}-all`, "Everything that was measured", figure(`${found.engine} less millscope, in standard errors over the starts. Filled: differs, all quantities judged together. Shaded: two standard errors.`,
        intervals(`${key}-dots`, { label: `Differences of ${usable.length} quantities in standard errors`, rows: usable.map((row) => row.name), groups: [{ name: "", values }], x: { name: "difference in standard errors" }, zero: 0, zone: [-2, 2] })),
      disclosure(`${key}-table`, `All ${rows.length} quantities`, () => quantities(rows, found, "All quantities"))),
      found.switches?.length ? block(`${key}-switches`, "What would explain it", switched(found.switches)) : null,
      found.differs?.length || found.left_out?.length ? block(`${key}-notes`, `What ${found.engine} defines in its own way`, found.differs?.length ? list(found.differs) : null,
        found.left_out?.length ? element("p", null, `Left out, because not every run tells it: ${found.left_out.join(", ")}.`) : null) : null],
  };
}
