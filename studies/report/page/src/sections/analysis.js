export function analysis() { return { kind: "analysis" }; }
