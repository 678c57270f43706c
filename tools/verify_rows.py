"""Rows of docs/validation.md."""


def row(what, found, wanted="", good=None):
    return {"what": what, "found": found, "wanted": wanted, "good": good}


def show(value, error, unit):
    return "%.4g ± %.2g %s" % (value, error, unit)
