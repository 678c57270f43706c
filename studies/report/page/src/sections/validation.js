export function validation() { return { kind: "validation" }; }
