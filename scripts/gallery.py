"""Makes the pictures of docs/gallery again: gallery.py PROGRAM [DATA].

Runs the commands of the gallery's pages and keeps the pictures that they make. DATA is the folder
of the data collection, ../shared/data beside the checkout if left out; without it only those that
need none are made. The pages' Python runs too, so the package must be importable.
"""

import os
import sys
import tempfile
from pathlib import Path

from page_code import ROOT, data_collection, run_page

GALLERY = ROOT / "docs" / "gallery"


def main(program: str, data: Path | None) -> None:
    program, before = str(Path(program).resolve()), Path.cwd()
    if data is None:
        print("no data collection: pictures that need it are left as they are")
    for page in "spot.md", "index.md":
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                run_page(GALLERY / page, Path(folder), program, data, GALLERY)
            finally:
                os.chdir(before)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else data_collection())
