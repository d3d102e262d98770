"""Blender 3.4 as Debian 12 packages it runs on a Python and a numpy that its add-ons do not know yet."""

import builtins

import numpy

_open = builtins.open


def _open_without_universal_newlines(file, mode="r", *arguments, **named):
    return _open(file, mode.replace("U", ""), *arguments, **named)


def install():
    """Makes `open(..., 'rU')` and `numpy.bool` work again."""
    builtins.open = _open_without_universal_newlines
    if "bool" not in numpy.__dict__:
        numpy.bool = bool
