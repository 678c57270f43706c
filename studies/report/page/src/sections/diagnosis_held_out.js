// Whether the corrected model predicts a condition that was not fitted, beside what else one might have done.
import { block, disclosure, element, figure, paragraph, table } from "../dom.js";
import { interval, isNumber, number, pValue, quantity, signed } from "../numbers.js";
import { bars, intervals } from "../plots/intervals.js";

const gain = (model) => model.improvement_of_corrected;

/// Files of before predictions have no `from`.
const source = (model) => (model.simulated ? "simulated" : model.from === "surrogate" ? "predicted from the bank" : model.from ? "computed from the simulated base" : "computed from others");

function observables(held, key) {
  const names = held.models.map((model) => model.model);
  return disclosure(`${key}-observables`, `All ${held.observables.length} numbers of ${held.condition}`, () => table({
    caption: `${held.condition}: recorded, and predicted by each model`, rows: held.observables, columns: [{ label: "observable", value: (row) => row.observable },
      { label: "unit", value: (row) => row.unit }, { label: "recorded", number: true, value: (row) => number(row.recorded) },
      ...names.map((name) => ({ label: name, number: true, value: (row) => number(row[name]) }))] }));
}

function condition(held, key, index) {
  const id = `${key}-held-${index + 1}`;
  const { models = [] } = held;
  const gained = models.filter(gain);
  const metered = isNumber(held.recorded_power_W); // a velocity profile tells no power
  const powered = models.filter((model) => isNumber(model.power_percent));
  return block(id, `Held out: ${held.condition}`,
    paragraph((metered ? `Recorded power ${quantity(held.recorded_power_W, "W")}. ` : "")
      + (held.improves_on_every_rival ? "The corrected model predicts this condition better than every rival model." : gained.length ? "The corrected model is not surely better than every rival model here." : "")),
    element("div", { class: "halves" }, figure("Misfit per number in the condition that was not fitted: about 1 when only chance differs, smaller where errors were taken cautiously, larger by what the fitted parameters are off by.",
      bars(`${id}-misfit`, { label: models.map((model) => `${model.model} ${number(model.misfit, 3)}`).join(", "), rows: models.map((model) => model.model),
        groups: [{ name: "", values: models.map((model) => model.misfit) }], x: { name: "misfit per number" } })),
    powered.length ? figure("Error of the predicted power.", bars(`${id}-power`, { label: powered.map((model) => `${model.model} ${signed(model.power_percent, 2)} %`).join(", "),
      rows: powered.map((model) => model.model), groups: [{ name: "", values: powered.map((model) => model.power_percent) }], x: { name: "predicted less recorded power", unit: "%" } })) : null),
    gained.length ? figure("What the correction gains on each rival model, with 90 % intervals: right of zero, it predicts better.", intervals(`${id}-gain`, {
      label: gained.map((model) => `${model.model} ${number(gain(model).value, 3)}`).join(", "), rows: gained.map((model) => model.model),
      groups: [{ name: "", values: gained.map((model) => ({ value: gain(model).value, low: gain(model).low90, high: gain(model).high90 })) }],
      x: { name: "misfit of the rival model less the corrected one's" }, zero: 0 })) : null,
    table({ caption: `Predictions for ${held.condition}`, rows: models, classOf: (model) => (model.model === "corrected" ? "strong" : null), columns: [
      { label: "model", value: (model) => model.model }, { label: "what it is", wide: true, value: (model) => model.is },
      { label: "from", value: source }, { label: "misfit", number: true, value: (model) => number(model.misfit, 3) },
      { label: "power (W)", number: true, value: (model) => number(model.power_W) }, { label: "error (%)", number: true, value: (model) => signed(model.power_percent, 2) },
      ...(gained.length ? [{ label: "gain of the corrected one (90 %)", number: true,
        value: (model) => (gain(model) ? `${number(gain(model).value, 3)} (${interval(gain(model).low90, gain(model).high90)})` : "–") }] : [])] }),
    isNumber(held.p_base) ? paragraph(`A recording of the refitted base would look as bad here with ${pValue(held.p_base)}.`) : null,
    held.observables?.length ? observables(held, id) : null);
}

export const heldOut = ({ held_out: all = [] }, key) => all.map((held, index) => condition(held, key, index));
