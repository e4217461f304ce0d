# SPDX-License-Identifier: GPL-3.0-or-later
"""The one pnb_context of this process."""

import atexit

from . import capi

_context = None
_backend = None     # what it was opened with


def context(backend):
    """The context, opened on first use and again when another backend is asked for."""
    global _context, _backend
    if _context is not None and _backend != backend:
        close()
    if _context is None:
        _context = capi.library().create('context', capi.ContextDesc(backend=backend.encode()))
        _backend = backend
    return _context


def close():
    global _context
    if _context is not None:
        capi.library().destroy('context', _context)
        _context = None


atexit.register(close)
