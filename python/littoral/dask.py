"""`littoral.batch` on a Dask cluster: a future for each shard."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from distributed import Client

from ._arguments import whole
from ._batch import BatchSummary
from ._batch import batch as _batch


def batch(
    client: Client, items: Any, work: Any, out: Any, *, shards: int = 0, **how: Any
) -> list[BatchSummary]:
    """As `littoral.batch`, in shards that are futures; `out` is a folder that all workers share.

    shards: 0 for four for each thread of the cluster. A shard whose worker ends is begun again by
    Dask on another one, and leaves out what is done.
    """
    count = whole(shards, "shards", " from 0 on", 0) or 4 * max(1, sum(client.nthreads().values()))
    how.setdefault("processes", 1)
    listed = items if isinstance(items, (str, os.PathLike, Mapping)) else list(items)
    futures = [
        client.submit(_batch, listed, work, out, shard=(k, count), pure=False, retries=10, **how)
        for k in range(1, count + 1)
    ]
    return list(client.gather(futures))
