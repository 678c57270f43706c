// A calibrated set held against recordings.
import { block, disclosure, element, figure, table } from "../dom.js";
import { INSIDE, interval, number, probability, quantity, signed, words } from "../numbers.js";
import { intervals } from "../plots/intervals.js";
import { scaleOf } from "./parameters.js";

const mark = (row) => element("span", { class: row.pass ? "pass" : "fail" }, row.pass ? "pass" : "fail");

const judged = (rows, caption) => table({ caption, rows, columns: [{ label: "observable", wide: true, value: (row) => row.name }, { label: "recorded", number: true, value: (row) => number(row.recorded) },
  { label: "simulated", number: true, value: (row) => number(row.simulated) }, { label: "difference", number: true, value: (row) => signed(row.difference, 3) },
  { label: "90 % interval", number: true, value: (row) => interval(row.low90, row.high90) }, { label: "unit", value: (row) => row.unit },
  { label: "p", number: true, value: (row) => probability(row.p) }, { label: "", value: mark }] });

function condition([name, found], key, index) {
  const id = `${key}-condition-${index + 1}`;
  if (found.failed) return block(id, name, element("p", { class: "missing" }, `The simulation failed: ${found.failed}`));
  const rows = found.observables ?? [];
  const passed = rows.filter((row) => row.pass).length;
  const usable = rows.filter((row) => row.error > 0);
  const values = usable.map((row) => ({ value: row.difference / row.error, low: row.low90 / row.error, high: row.high90 / row.error, hollow: row.pass,
    text: `${signed(row.difference, 3)} ${row.unit} (${interval(row.low90, row.high90)}), p ${probability(row.p)}` }));
  return block(id, `${name}: ${passed} of ${rows.length} pass one by one`, figure(`${name} (${words(found.role)}): simulated less recorded in standard errors, with 90 % intervals. Hollow: passes; filled: fails. `
    + "Shaded: nine of ten numbers lie there when nothing differs.", intervals(`${id}-dots`, { label: `${passed} of ${rows.length} numbers of ${name} pass`, rows: usable.map((row) => row.name),
    groups: [{ name: "", values }], x: { name: "difference in standard errors" }, zero: 0, zone: [-INSIDE, INSIDE] })),
  disclosure(`${id}-table`, `All ${rows.length} numbers of ${name}`, () => judged(rows, `${name}: recorded and simulated`)));
}

export function validation(section, key) {
  const { validation: found } = section;
  const conditions = Object.entries(found.conditions ?? {});
  const simulated = conditions.filter((one) => !one[1].failed).map(([name, one]) => ({ condition: name, ...one }));
  const powers = simulated.filter((one) => one.power).map((one) => ({ condition: one.condition, role: one.role, ...one.power }));
  const failed = conditions.length - simulated.length;
  const told = Object.entries(found.parameters ?? {}).map(([name, value]) => [words(name), `${number(value * scaleOf(name).factor)}${scaleOf(name).unit ? ` ${scaleOf(name).unit}` : ""}`, "simulated value"]);
  return {
    kind: "Validation", sentence: `The calibrated set ${found.at_once && found.passed === found.judged ? "describes" : "does not describe"} these recordings: one by one, ${found.passed} of ${found.judged} numbers pass; all numbers of a condition at once ${found.at_once ? "pass" : "do not"}.`
      + (failed ? ` ${failed} ${failed === 1 ? "simulation" : "simulations"} failed.` : ""),
    headline: [["Verdict", found.pass ? "pass" : "fail", `at ${number(100 * found.family_wise_level)} % for all tests`],
      ...powers.map((row) => [`Power at ${row.condition}`, `${signed(row.percent, 2)} %`, `${quantity(row.simulated, "W")}, recorded ${quantity(row.recorded, "W")}`]), ...told],
    blocks: [
      block(`${key}-at-once`, "All numbers at once", table({ caption: "All numbers of a condition at once: each small difference alone may be chance, while all of them are too much for it", rows: simulated, columns: [{ label: "condition", value: (row) => row.condition },
        { label: "role", value: (row) => words(row.role) }, { label: "misfit", number: true, value: (row) => number(row.misfit, 3) },
        { label: "usual misfit", number: true, value: (row) => row.observables?.length ?? 0 }, { label: "p", number: true, value: (row) => probability(row.p) }, { label: "", value: mark }] })),
      powers.length ? block(`${key}-power`, "Power", table({ caption: "Power of the recorded and of the simulated mill", rows: powers, columns: [{ label: "condition", value: (row) => row.condition },
        { label: "role", value: (row) => words(row.role) }, { label: "recorded (W)", number: true, value: (row) => number(row.recorded) }, { label: "simulated (W)", number: true, value: (row) => number(row.simulated) },
        { label: "difference (W)", number: true, value: (row) => signed(row.difference, 3) }, { label: "90 % interval (W)", number: true, value: (row) => interval(row.low90, row.high90) },
        { label: "difference (%)", number: true, value: (row) => signed(row.percent, 2) }, { label: "p", number: true, value: (row) => probability(row.p) }, { label: "", value: mark }] })) : null,
      ...conditions.map((one, index) => condition(one, key, index))],
  };
}
