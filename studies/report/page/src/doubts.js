// What a run, or the simulations of a study, give cause to doubt.
import { element, list } from "./dom.js";
import { number } from "./numbers.js";

function sentence(doubt) {
  const told = `${doubt.finding}; ${doubt.may_change}. Remedy: ${doubt.remedy}.`;
  if (!("said_by" in doubt)) return told;
  return `${number(doubt.said_by)} of ${number(doubt.simulations)} simulations${doubt.said_by > 1 ? ", the worst" : ""}: ${told}`;
}

/** Null where there is none. */
export const doubtsElement = (doubts) => (doubts?.length
  ? element("div", { class: "missing doubts" }, element("h3", null, "Doubts"), list(doubts.map(sentence))) : null);

/** For the contents. */
export const doubtsCount = (doubts) => (doubts?.length ? `Doubts: ${number(doubts.length)}.` : null);
