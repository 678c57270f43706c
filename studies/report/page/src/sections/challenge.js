export function challenge() { return { kind: "challenge" }; }
