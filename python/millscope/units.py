"""Names that end with their unit, as series.csv and summary.json have them."""

from __future__ import annotations

import re

WORDS = {"": "", "1": "", "%": "percent"}


def suffix(unit: str) -> str:
    """A unit as the end of a name: 'm/s' → 'm_per_s', 'N m' → 'N_m', '1/s' → 'per_s', '%' → 'percent', '1' → ''."""
    if unit in WORDS:
        return WORDS[unit]
    above, _, below = unit.partition("/")
    parts = [above] if above != "1" else []
    parts += ["per", below] if below else []
    return re.sub(r"[^0-9A-Za-z]+", "_", "_".join(parts).replace("^", "")).strip("_")


def with_unit(name: str, unit: str) -> str:
    """'speed', 'm/s' → 'speed_m_per_s'; a name that ends with its unit already stays."""
    end = suffix(unit)
    return name if not end or name.endswith("_" + end) else f"{name}_{end}"
