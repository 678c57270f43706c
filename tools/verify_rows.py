"""Rows of docs/validation.md."""


class NotRun(Exception):
    """A run that is not complete, where only complete ones are to be used."""


def row(what, found, wanted="", good=None):
    return {"what": what, "found": found, "wanted": wanted, "good": good}


def show(value, error, unit):
    return "%.4g ± %.2g %s" % (value, error, unit)
