// A run: the turning mill, its power, where the energy went, and what it was made with.
import { disclosure, element, facts, figure, block, note, paragraph, table } from "../dom.js";
import { isNumber, moment, number, percent, quantity, withError } from "../numbers.js";
import { Mill } from "../three/mill.js";
import { collisions, dissipation, ledger, spectra } from "./run_energy.js";
import { powerChart } from "./run_power.js";

const mills = new Map(); // by section: a live page keeps the 3-D with its place and view

const STATES = { done: "finished", running: "still running", stopped: "stopped before its end" };

function movieBlock(section, key) {
  const id = `${key}-mill`;
  const { movie } = section;
  if (!movie) return section.state === "running" ? block(id, "The mill turning", note("Pictures of the beads come as soon as the run has written some.")) : null;
  if (!mills.has(key)) mills.set(key, new Mill(section.title, movie.beads));
  const mill = mills.get(key);
  if (!mill.works)
    return block(id, "The mill turning", element("p", { class: "missing" }, "This browser shows no 3-D (WebGL 2 is missing or switched off), so the beads are not drawn. All else on this page works."));
  const trouble = element("p", { class: "missing", hidden: true });
  mill.load(section).catch((error) => {
    trouble.textContent = `The beads cannot be drawn: ${error.message}`;
    trouble.hidden = false;
  });
  const left = movie.beads_left_out > 0 ? ` ${number(movie.beads_left_out)} more beads are left out, to keep this page small${section.summary?.engine?.name === "imported" ? " or because they are not in every frame" : ""}.` : "";
  return block(id, "The mill turning", figure(`${number(movie.beads)} beads at ${movie.frames} instants, without perspective.${left} `
    + "x to the right, y up, z towards you. Drag or use the arrow keys to turn; the cut leaves out what lies nearer to you along the axis.",
    mill.element), trouble);
}

function headline({ summary, series, mill, progress, state }) {
  const power = summary?.power_W;
  const speed = summary?.mill_speed_rad_per_s ?? mill?.omega_rad_per_s;
  const sense = speed > 0 ? "counter-clockwise" : "clockwise";
  const last = (name) => (series?.[name]?.length ? series[name][series[name].length - 1] : null);
  return [
    isNumber(power?.torque) && ["Power, by the torque", withError(power.torque, power.torque_sem, "W"), "mean ± standard error"],
    power && ["Power, by the charge's place", withError(power.com, power.com_sem, "W"), "weight × lever arm × speed"],
    power && isNumber(power.dissipation) && ["Power, by the losses", withError(power.dissipation, power.dissipation_sem, "W"), null],
    !summary && ["Power now, by the charge's place", quantity(last("power_com_W"), "W"), "one instant, no mean yet"],
    isNumber(speed) && speed !== 0 && ["Speed", quantity(Math.abs(speed), "rad/s"), sense],
    summary && ["Charge", `${number(summary.particles, 7)} beads`, quantity(summary.charge_mass_kg, "kg")],
    progress && ["Simulated so far", `${number(progress.time_s, 3)} of ${number(progress.end_s, 3)} s`, percent(progress.time_s / progress.end_s, 2)],
    summary && ["Simulated", `${number(summary.simulated_s, 3)} s`, summary.window_s ? `means from ${number(summary.window_s[0], 3)} s on` : null],
    summary && "steady" in summary && ["Steady", summary.steady ? "yes" : "no", summary.steady_reason
      ?? (summary.steadiness ? `its halves differ by ${quantity(Math.abs(summary.steadiness.com_power_drift_W), "W", 2)}` : null)],
    !summary && ["State", STATES[state] ?? state, null],
  ];
}

function sentence({ summary, state, progress }) {
  const engine = summary?.engine ? ` Another engine moved the beads: ${summary.engine.name === "imported" ? summary.engine.version : summary.engine.name}.` : "";
  const by = ["torque", "com"].find((name) => isNumber(summary?.power_W?.[name]));
  if (by) {
    const steady = summary.steady === false ? " The mill is not steady: do not trust the mean." : "";
    return `The mill draws ${withError(summary.power_W[by], summary.power_W[`${by}_sem`], "W")}${by === "com" ? ", by the charge's place" : ""}.${steady}${engine}`;
  }
  if (state === "running") return progress ? `The run has come to ${number(progress.time_s, 3)} s of ${number(progress.end_s, 3)} s.` : "The run goes on.";
  return state === "stopped" ? "The run was stopped before its end: there are no means." : `The run is finished.${engine}`;
}

function provenance(summary, key) {
  const from = summary?.provenance;
  if (!from) return null;
  const seed = /--seed[= ](\S+)/.exec((from.command_line ?? []).join(" "));
  return [
    facts([["millscope", from.commit ? `${from.version}, commit ${from.commit}` : from.version, from.compiler], ["Made", moment(from.date_utc), null], ["Machine", from.host, `${from.processor ?? ""}, ${number(from.cores)} cores`],
      summary.engine && ["Engine", summary.engine.version, isNumber(summary.engine.ranks) ? `${number(summary.engine.ranks)} processes` : null],
      summary.state_hash && ["State hash", element("code", null, summary.state_hash), "equal where two runs are equal to the bit"], seed && ["Seed", seed[1], null],
      isNumber(summary.dt_s) && ["Time step", quantity(summary.dt_s, "s"), `${percent(summary.dt_rayleigh_fraction)} of the Rayleigh time`],
      isNumber(summary.stiffness_factor) && ["Stiffness", `× ${number(summary.stiffness_factor)}`, "of the real materials"],
      isNumber(summary.wall_s) && ["Computed in", `${number(summary.wall_s, 3)} s`,
        isNumber(summary.particle_steps_per_s) ? `${number(summary.particle_steps_per_s / 1e6, 3)} million bead steps per second` : null]]),
    element("p", null, "Command: ", element("code", null, (from.command_line ?? []).join(" "))),
    disclosure(`${key}-plugins`, `Plugins (${(from.plugins ?? []).length}) with their hashes`, () => table({ caption: "Plugins that were loaded", rows: from.plugins ?? [],
      columns: [{ label: "name", value: (row) => row.name }, { label: "version", value: (row) => row.version },
        { label: "hash of the file", value: (row) => element("code", null, row.hash) },
        { label: "hash of the code", value: (row) => element("code", null, row.code_hash ?? "") }] })),
  ];
}

export function run(section, key) {
  const { summary } = section;
  const seed = /^seed:\s*(\S+)/m.exec(section.case ?? "");
  return {
    kind: "Run", sentence: sentence(section), doubts: summary?.doubts, headline: headline(section),
    blocks: [
      movieBlock(section, key), powerChart(section, key), ledger(summary, key), spectra(summary, key), dissipation(summary, key), collisions(summary, key),
      block(`${key}-provenance`, "What it was made with", provenance(summary, key), seed ? paragraph("Seed of the case: ", element("code", null, seed[1])) : null,
        section.case ? disclosure(`${key}-case`, "The case, with every default", () => element("pre", { tabindex: 0 }, section.case)) : null),
    ],
  };
}
