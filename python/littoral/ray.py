"""`littoral.batch` on a Ray cluster: a task for each shard."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import ray

from ._arguments import whole
from ._batch import BatchSummary
from ._batch import batch as _batch


def batch(items: Any, work: Any, out: Any, *, shards: int = 0, **how: Any) -> list[BatchSummary]:
    """As `littoral.batch`, in shards that are tasks of one CPU each; `out` is a folder they share.

    shards: 0 for four for each CPU of the cluster. A task whose worker ends is begun again by Ray,
    and leaves out what is done.
    """
    count = whole(shards, "shards", " from 0 on", 0) or 4 * max(
        1, int(ray.cluster_resources().get("CPU", 1))
    )
    how.setdefault("processes", 1)
    task = ray.remote(num_cpus=1, max_retries=-1)(_batch)
    listed = ray.put(items if isinstance(items, (str, os.PathLike, Mapping)) else list(items))
    return list(
        ray.get(
            [task.remote(listed, work, out, shard=(k, count), **how) for k in range(1, count + 1)]
        )
    )
