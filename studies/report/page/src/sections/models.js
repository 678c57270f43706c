// What one may do about a mismatch, by the names of the files: before, and after. Each has one name and one colour in all charts.
import { line } from "../colours.js";

export const TO_POWER = { model: "retuned to power", name: "retuned to the power alone", colour: line(1) };
export const TO_ALL = { model: "retuned to all observables", name: "retuned to all numbers", colour: line(0) };
export const CORRECTED = { model: "corrected", name: "corrected", colour: line(2) };
