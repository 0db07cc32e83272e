"""The names and files that the documentation points to exist in the code."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LAYERS = "base|spatial|solve|domain|operators|sources|contour|methods|io|api|cli"
FILE = re.compile(rf"`((?:{LAYERS}|src|tests|bench|include|examples|scripts)/[\w/.-]+\.\w+)`")
FUNCTION = re.compile(r"`(\w+(?:::\w+)+)`")


def pages() -> list[Path]:
    return [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md"]


def test_files_that_the_docs_name_exist() -> None:
    missing = [
        f"{page.name}: {name}"
        for page in pages()
        for name in FILE.findall(page.read_text(encoding="utf-8"))
        if not (ROOT / name).exists() and not (ROOT / "src" / name).exists()
    ]
    assert missing == []


def test_functions_that_the_docs_name_exist() -> None:
    sources = [p for d in ("src", "include", "tests") for p in (ROOT / d).rglob("*")]
    code = "\n".join(p.read_text(encoding="utf-8") for p in sources if p.suffix in {".h", ".cpp"})
    words = set(re.findall(r"\w+", code)) | {"std", "littoral"}
    missing = [
        f"{page.name}: {name}"
        for page in pages()
        for name in FUNCTION.findall(page.read_text(encoding="utf-8"))
        if any(word not in words for word in name.split("::"))
    ]
    assert missing == []
