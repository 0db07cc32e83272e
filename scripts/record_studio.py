"""Makes docs/gallery/studio.webp, a recording of the studio: record_studio.py.

Needs dist/studio.html (`make web`), Node and Chromium, as the stage `web` of the tests does; Pillow
comes with Matplotlib.
"""

import subprocess
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "docs/gallery/studio.webp"


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["node", str(ROOT / "web/studio/record.mjs"), folder], check=True)
        frames = [Image.open(file).convert("RGB") for file in sorted(Path(folder).glob("*.png"))]
    durations = [120] * len(frames)
    durations[0], durations[-1] = 900, 1500
    frames[0].save(
        OUT,
        save_all=True,
        append_images=frames[1:],
        duration=durations,
        loop=0,
        quality=60,
        method=4,
        minimize_size=True,
    )
    print(f"{OUT}: {len(frames)} frames, {OUT.stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
