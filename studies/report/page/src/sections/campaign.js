// The simulations of a study, done and to be done.
import { block, element, figure, table } from "../dom.js";
import { line } from "../colours.js";
import { number, percent, quantity } from "../numbers.js";
import { bars } from "../plots/intervals.js";

const STATES = [["done", 2], ["running", 0], ["waiting", 7], ["failed", 1]];

export function campaign(section, key) {
  const { tasks = [] } = section;
  const count = (state) => section[state] ?? tasks.filter((task) => task.state === state).length;
  const all = STATES.reduce((sum, [state]) => sum + count(state), 0);
  const failed = tasks.filter((task) => task.state === "failed");
  const when = (task) => (task.changed_unix_s > 0 ? new Date(task.changed_unix_s * 1000).toISOString().slice(0, 19).replace("T", " ") : "–");
  return {
    kind: "Campaign", sentence: `${number(count("done"))} of ${number(all)} simulations are done`
      + `${count("running") ? `, ${number(count("running"))} running` : ""}${count("waiting") ? `, ${number(count("waiting"))} waiting` : ""}${count("failed") ? `, ${number(count("failed"))} failed` : ""}.`,
    headline: STATES.map(([state]) => [state, number(count(state)), all > 0 ? percent(count(state) / all) : null]),
    blocks: [
      all > 0 ? block(`${key}-progress`, "Progress", figure("Simulations by state.", bars(`${key}-progress`, { label: STATES.map(([state]) => `${count(state)} ${state}`).join(", "), rows: ["simulations"],
        groups: STATES.map(([state, colour]) => ({ name: state, colour: line(colour), values: [count(state)] })), x: { name: "number of simulations", min: 0, max: all }, stacked: true }))) : null,
      failed.length ? block(`${key}-failed`, "Failed", table({ caption: "Simulations that failed, and why", rows: failed, columns: [{ label: "simulation", value: (task) => task.label },
        { label: "why", wide: true, value: (task) => task.message ?? "" }] })) : null,
      tasks.length ? block(`${key}-tasks`, "All simulations", element("div", { class: "tall" }, table({ caption: "The one that changed last comes last", rows: tasks, columns: [
        { label: "simulation", value: (task) => task.label }, { label: "state", value: (task) => element("span", { class: task.state === "failed" ? "fail" : null }, task.state) },
        { label: "done", number: true, value: (task) => percent(task.fraction) }, { label: "computed for", number: true, value: (task) => quantity(task.wall_s, "s", 3) },
        { label: "last change (UTC)", value: when }] }))) : null],
  };
}
