// Where the energy of a run went: the ledger, impacts, losses and collisions.
import { block, figure, paragraph, table } from "../dom.js";
import { isNumber, number, percent, quantity, scale, words } from "../numbers.js";
import { bars } from "../plots/intervals.js";
import { lines, stairs } from "../plots/lines.js";

export function ledger(summary, key) {
  const energy = summary?.energy;
  if (!energy || !isNumber(energy.wall_work_J)) return null;
  const rows = [["given by the walls", energy.wall_work_J], ["lost", energy.dissipated_J], ["stored", energy.stored_change_J], ["imbalance", energy.imbalance_J]];
  const by = scale("J", rows.map((row) => row[1]));
  return block(`${key}-energy`, "Energy ledger",
    figure(`Over the ${number(energy.mean_power_span_s, 3)} s of the analysis window. What the walls gave is lost or stored; the rest is what the arithmetic does not account for.`,
      bars(`${key}-energy`, { label: `Energy: ${rows.map(([name, value]) => `${name} ${quantity(value, "J")}`).join(", ")}`, rows: rows.map((row) => row[0]),
        groups: [{ name: "", values: rows.map((row) => row[1] * by.factor) }], x: { name: "energy", unit: by.unit } })),
    table({ caption: "Energy in the analysis window", rows, columns: [{ label: "", value: (row) => row[0] },
      { label: `energy (${by.unit})`, number: true, value: (row) => number(row[1] * by.factor) },
      { label: "share of what was given", number: true, value: (row) => percent(row[1] / Math.abs(energy.wall_work_J), 4) }] }));
}

/** Edges of the bins: the last one is as wide, in the logarithm, as the one before it. */
function edgesOf(lower) {
  const step = lower.length > 1 ? lower[lower.length - 1] / lower[lower.length - 2] : 10 ** 0.25;
  return [...lower, lower[lower.length - 1] * step];
}

export function spectra(summary, key) {
  const span = summary?.energy?.mean_power_span_s;
  const pairs = (summary?.pairs ?? []).filter((pair) => pair.impact_spectrum?.lower_edge_J?.length > 0);
  if (pairs.length === 0 || !(span > 0)) return null;
  const series = pairs.map((pair) => ({ name: pair.pair,
    points: stairs(edgesOf(pair.impact_spectrum.lower_edge_J), pair.impact_spectrum.count.map((count) => (count > 0 ? count / span : null))) }));
  return block(`${key}-impacts`, "Impacts", figure("First touches per second in each class of impact energy (½ m* v², v: closing speed along the normal), both axes logarithmic.",
    lines(`${key}-impacts`, { label: `Impact spectra of ${pairs.map((pair) => pair.pair).join(", ")}`, series, x: { name: "impact energy", unit: "J", log: true },
      y: { name: "collisions per second and class", unit: "1/s", log: true }, height: 340 })));
}

export function dissipation(summary, key) {
  const pairs = (summary?.pairs ?? []).filter((pair) => pair.dissipation_W);
  const channels = [...new Set(pairs.flatMap((pair) => Object.keys(pair.dissipation_W)))];
  if (channels.length === 0) return null;
  const all = pairs.flatMap((pair) => Object.values(pair.dissipation_W));
  const by = scale("W", all);
  const total = all.reduce((sum, value) => sum + value, 0);
  const name = (channel) => words(channel.split(".").pop());
  const values = (channel) => pairs.map((pair) => (pair.dissipation_W[channel] ?? 0) * by.factor);
  return block(`${key}-losses`, "Where the power goes",
    figure("Losses by pair of materials and channel. A channel below zero gives back what another one lost.",
      bars(`${key}-losses`, { label: `Losses by pair and channel, ${quantity(total, "W")} in all`, rows: pairs.map((pair) => pair.pair),
        groups: channels.map((channel) => ({ name: name(channel), values: values(channel) })), x: { name: "power lost", unit: by.unit }, stacked: true })),
    table({ caption: `Power lost (${by.unit})`, rows: pairs, columns: [{ label: "pair", value: (pair) => pair.pair },
      ...channels.map((channel) => ({ label: name(channel), number: true, value: (pair) => number((pair.dissipation_W[channel] ?? NaN) * by.factor) })),
      { label: "share of all", number: true, value: (pair) => percent(Object.values(pair.dissipation_W).reduce((sum, value) => sum + value, 0) / total, 3) }] }));
}

export function collisions(summary, key) {
  const pairs = summary?.pairs ?? [];
  if (pairs.length === 0) return null;
  const { contact } = summary;
  const power = scale("W", pairs.map((pair) => pair.impact_energy_W));
  const resolved = contact && isNumber(contact.steps_per_shortest_contact)
    ? paragraph(`The shortest contact, at ${quantity(contact.largest_closing_speed_m_per_s, "m/s", 3)}, lasts about ${number(contact.steps_per_shortest_contact, 3)} time steps.`) : null;
  return block(`${key}-collisions`, "Collisions", table({ caption: "Collisions by pair of materials", rows: pairs, columns: [
    { label: "pair", value: (pair) => pair.pair }, { label: "per second", number: true, value: (pair) => number(pair.collisions_per_s, 3) },
    { label: `impact energy (${power.unit})`, number: true, value: (pair) => number(pair.impact_energy_W * power.factor, 3) },
    { label: "largest closing speed (m/s)", number: true, value: (pair) => number(pair.largest_closing_speed_m_per_s, 3) },
    { label: "largest overlap (% of radius)", number: true, value: (pair) => number(100 * pair.largest_overlap_of_effective_radius, 3) }] }), resolved);
}
