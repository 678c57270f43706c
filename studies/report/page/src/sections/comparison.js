export function comparison() { return { kind: "comparison" }; }
