// The page: reads its data, writes its sections, and keeps up with a run that goes on.
import { drawVisible } from "./chart.js";
import { checked, readDocument } from "./data.js";
import { element, facts, list } from "./dom.js";
import { doubtsCount, doubtsElement } from "./doubts.js";
import { follow } from "./live.js";
import { analysis } from "./sections/analysis.js";
import { calibration } from "./sections/calibration.js";
import { campaign } from "./sections/campaign.js";
import { challenge } from "./sections/challenge.js";
import { comparison } from "./sections/comparison.js";
import { crosscheck } from "./sections/crosscheck.js";
import { diagnosis } from "./sections/diagnosis.js";
import { run } from "./sections/run.js";
import { validation } from "./sections/validation.js";
import { wear } from "./sections/wear.js";

const KINDS = { run, analysis, comparison, campaign, calibration, validation, diagnosis, challenge, crosscheck, wear };

const byId = (id) => document.getElementById(id);
const shown = []; // what stands in the page: {text, part, answer}

function content(section, key) {
  const make = Object.hasOwn(KINDS, section.kind) ? KINDS[section.kind] : null;
  if (!make) return { kind: String(section.kind), broken: `This page does not know sections of the kind "${section.kind}": make it with a newer millscope.` };
  try {
    return make(section, key);
  } catch (error) {
    console.error(error);
    return { kind: section.kind, broken: `This section cannot be shown, because its data are not as expected (${error.message}). The rest of the page is whole.` };
  }
}

function sectionElement(section, index) {
  const key = `s${index + 1}`;
  const { kind, answer, sentence, doubts, headline = [], blocks = [], broken } = content(section, key);
  const notes = section.notes?.length ? element("div", { class: "notes" }, element("h3", null, "Notes"), list(section.notes)) : null;
  const part = element("section", { class: "part", id: key, "data-kind": section.kind, "data-sentence": [sentence, doubtsCount(doubts)].filter(Boolean).join(" ") },
    element("header", null, element("p", { class: "kind" }, kind, section.source ? [" · ", element("code", null, section.source)] : null),
      element("h2", null, section.title)),
    broken ? element("p", { class: "missing broken", role: "alert" }, broken) : null,
    sentence ? element("p", { class: "sentence" }, sentence) : null, answer ? null : doubtsElement(doubts), headline.some(Boolean) ? facts(headline) : null, blocks, notes);
  return { part, answer };
}

function writeContents() {
  const items = [...document.querySelectorAll("main > .part")].map((section) => {
    const blocks = [...section.querySelectorAll(":scope > section.block")];
    const links = blocks.map((one) => element("li", null, element("a", { href: `#${one.id}` }, one.dataset.title)));
    return element("li", null, element("a", { href: `#${section.id}` }, section.querySelector("h2").textContent), " ",
      element("span", { class: "kind" }, section.querySelector(".kind").firstChild.textContent),
      section.dataset.sentence ? element("p", null, section.dataset.sentence) : null, links.length ? element("ul", null, links) : null);
  });
  byId("contents").replaceChildren(element("h2", null, "Contents"), element("ol", null, items));
}

function writeHead(page) {
  document.title = page.title;
  const made = page.made_utc ? new Date(page.made_utc) : null;
  const when = made && !Number.isNaN(made.getTime()) ? `${made.toISOString().slice(0, 16).replace("T", " ")} UTC` : "";
  byId("head").replaceChildren(element("h1", null, page.title), element("p", { class: "made" },
    ["millscope", page.version, when && `· ${page.live ? "state of" : "made"} ${when}`].filter(Boolean).join(" ")));
  byId("made").textContent = page.live ? "Served by millscope watch." : "One file with all its data; it asks for nothing from any network.";
}

/** Answers come before all, the contents after them; the contents of a page without an answer stand above what is skipped to. */
function placeAnswers(main, answers) {
  const contents = byId("contents");
  if (answers.length > 1) for (const one of answers) one.querySelector("h2").textContent = `The answer: ${one.dataset.title}`;
  if (answers.length) main.prepend(...answers, contents);
  else main.before(contents);
}

/** Writes what has changed; what has not stays as the reader left it. */
function write(page) {
  writeHead(page);
  const main = byId("report");
  const [focused, scroll] = [document.activeElement, window.scrollY];
  page.sections.forEach((section, index) => {
    const text = JSON.stringify(section);
    if (shown[index]?.text === text) return;
    const fresh = sectionElement(section, index);
    if (shown[index]) shown[index].part.replaceWith(fresh.part);
    else main.append(fresh.part);
    shown[index]?.answer?.remove();
    shown[index] = { text: page.live ? text : "", ...fresh };
  });
  for (const old of shown.splice(page.sections.length)) [old.part, old.answer].forEach((one) => one?.remove());
  placeAnswers(main, shown.map((one) => one.answer).filter(Boolean));
  if (page.sections.length === 0) main.replaceChildren(element("p", { class: "missing" }, "There is nothing in this report."));
  writeContents();
  if (focused && focused !== document.activeElement && focused.isConnected) focused.focus({ preventScroll: true });
  if (window.scrollY !== scroll) window.scrollTo({ top: scroll, behavior: "instant" });
  drawVisible();
}

try {
  const page = readDocument();
  write(page);
  if (location.hash.length > 1) byId(location.hash.slice(1))?.scrollIntoView();
  if (page.live) follow((next) => write(checked(next)), byId("server"));
} catch (error) {
  console.error(error);
  byId("report").replaceChildren(element("p", { class: "missing broken", role: "alert" }, error.message));
}
