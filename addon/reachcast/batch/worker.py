# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender that is one of several: it makes the units that the first one sends, and ends with it."""
from __future__ import annotations

import os
import pickle
import sys
from pathlib import Path

from .. import native
from ..corpora import opened_corpus
from .stage import Stage
from .store import DiskFull, Store
from .unit_work import work

GREETING = b"\nreachcast-batch-worker\n"   #: what comes before it on standard output is Blender's own


def main() -> None:
    """Pickles on standard input: (folder, corpus), then (unit, checksum), ... until it is closed; a reply to each."""
    replies = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what Blender and its exporters print is no reply
    replies.write(GREETING)
    replies.flush()
    orders = sys.stdin.buffer
    out, corpus = pickle.load(orders)
    store = Store(Path(out))
    try:
        stage = Stage(opened_corpus(native.core(), corpus))
        _reply(replies, None)
        while True:
            unit, checksum = pickle.load(orders)
            _reply(replies, work(store, stage, unit, checksum))
    except EOFError:
        pass
    except Exception as error:  # noqa: BLE001  it is raised in the process that started this one
        try:
            store.refuse_full(error)
        except DiskFull as full:
            error = full
        _reply(replies, error)
    finally:
        store.close()


def _reply(replies, what: object) -> None:  # type: ignore[no-untyped-def]
    """Seconds by step, None once it is ready, or the exception that ends the whole run."""
    pickle.dump(what, replies)
    replies.flush()
