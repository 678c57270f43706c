"""Rows of docs/validation.md."""


class NotRun(Exception):
    """A run that is not complete, where only complete ones are to be used."""


def row(what, found, wanted="", good=None):
    return {"what": what, "found": found, "wanted": wanted, "good": good}


class Absent(dict):
    """The only row of an item that cannot be run here; what the page says of the item stays."""


def absent(what, why):
    return [Absent(row(what, why))]


def show(value, error, unit):
    return "%.4g ± %.2g %s" % (value, error, unit)


def power(summary, kind):
    return summary["power_W"][kind], summary["power_W"][kind + "_sem"]


def three_powers(s):
    values = [s["power_W"][k] for k in ("torque", "com", "dissipation")]
    spread = (max(values) - min(values)) / abs(sum(values) / 3)
    return row("largest difference of the three powers", "%.2f %%" % (100 * spread), "< 0.5 %", spread < 0.005)
