export function calibration() { return { kind: "calibration" }; }
