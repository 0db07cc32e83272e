"""The names and files that the documentation points to exist in the code."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LAYERS = "base|spatial|solve|domain|operators|sources|contour|methods|io|api|cli"
FILE = re.compile(
    rf"`((?:{LAYERS}|src|tests|bench|include|examples|scripts|viewer|web|python)/[\w/.-]+\.\w+)`"
)
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


def test_names_that_the_docs_give_with_a_file_are_in_it() -> None:
    names = r"(?:`[\w:]+`(?:, | and )?)+"
    missing = []
    count = 0
    for page in pages():
        text = page.read_text(encoding="utf-8")
        for file, given in re.findall(rf"`([\w/]+)\.(?:cpp|h)`: ({names})", text):
            found = [ROOT / top / f"{file}{end}" for top in ("src", ".") for end in (".h", ".cpp")]
            code = "".join(p.read_text(encoding="utf-8") for p in found if p.exists())
            words = set(re.findall(r"\w+", code))
            for name in re.findall(r"`([\w:]+)`", given):
                count += 1
                if not words.issuperset(name.split("::")):
                    missing.append(f"{page.name}: {file}: {name}")
    assert count > 50
    assert missing == []


def test_methods_that_the_citation_names_exist() -> None:
    notes = re.findall(r"notes: methods? (.+)", (ROOT / "CITATION.cff").read_text())
    options = (ROOT / "include/littoral/options.h").read_text()
    known = set(re.findall(r'method = "([\w-]+)"', options))
    assert len(notes) > 10
    assert {name for note in notes for name in note.split(", ")} == known


def literals() -> str:
    """All string literals of the sources, those in a row joined, quotes and backslashes gone."""
    code = "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "src").rglob("*.cpp"))
    code += "\n".join(p.read_text(encoding="utf-8") for p in (ROOT / "src").rglob("*.h"))
    joined = re.sub(r'(?<!\\)"\s*"', "", code)
    return "\n".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', joined))


def test_fields_of_reports_that_the_docs_name_exist() -> None:
    page = (ROOT / "docs/reference/report.md").read_text(encoding="utf-8")
    known = literals()
    cells = re.findall(r"^\| (`[^|]+) \|", page.split("## Sizes")[1], re.M)
    names = [name for cell in cells for name in re.findall(r"`([^`]+)`", cell)]
    assert len(names) > 40
    assert [name for name in names if name.lstrip(". ") not in known] == []


def test_every_field_of_reports_is_in_the_docs() -> None:
    page = (ROOT / "docs/reference/report.md").read_text(encoding="utf-8")
    added = re.compile(r'report\.(?:sizes|iterations|residuals)\.emplace_back\(\s*"([^"]+)"')
    names = {
        name
        for file in (ROOT / "src").rglob("*.cpp")
        for name in added.findall(file.read_text(encoding="utf-8"))
    }
    assert len(names) > 60
    assert sorted(name for name in names if f"`{name}`" not in page) == []


def test_every_name_of_the_package_has_its_entry() -> None:
    package = ast.parse((ROOT / "python/littoral/__init__.py").read_text(encoding="utf-8"))
    lists = [
        ast.literal_eval(node.value)
        for node in package.body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    ]
    page = (ROOT / "docs/reference/python.md").read_text(encoding="utf-8")
    entries = re.findall(r"^::: littoral\.(\w+)$", page, re.M)
    assert len(lists) == 1
    assert sorted(entries) == sorted(set(lists[0]) - {"__version__"})


def test_every_public_header_is_in_the_table() -> None:
    page = (ROOT / "docs/reference/cpp.md").read_text(encoding="utf-8")
    headers = {file.name for file in (ROOT / "include/littoral").glob("*.h")}
    named = set(re.findall(r"`(\w+\.h)`", page))
    assert len(headers) > 20
    assert sorted(headers - named - {"littoral.h"}) == []
    assert sorted(named - headers) == []
