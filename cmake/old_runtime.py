"""What a module is linked to so that it loads on older systems than the one it is built on.

usage: old_runtime.py GLIBC COMPILER FOLDER

Writes into FOLDER libraries without code that offer what systems with that version of glibc do:
glibc's from Zig, which knows what each version held; GCC's C++ library from the present one, whose
symbols carry the version that brought them. What is newer in that library is taken from its
archive, as Red Hat's compilers for older systems do. Prints the arguments for the linker, separated
by semicolons.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

from elftools.elf.elffile import ELFFile

# The newest that auditwheel's manylinux_2_28 allows, GCC 7's.
NEWEST = {"GLIBCXX": (3, 4, 24), "CXXABI": (1, 3, 11)}
GLIBC_PARTS = r"(lib(m|c|pthread|dl|ld)\.so\.\d+|libc_nonshared\.a)"


def output_of(*command: str) -> str:
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        sys.exit(f"{' '.join(command)}:\n{run.stderr}")
    return run.stdout + run.stderr


def glibc_parts(version: str, machine: str, folder: Path) -> list[str]:
    """Zig's libraries for that version of glibc, which it names when it links to them."""
    (folder / "empty.c").write_text("void nothing(void) {}\n")
    zig = (sys.executable, "-m", "ziglang", "cc", "-target", f"{machine}.{version}", "-O2")
    said = output_of(*zig, "-shared", "-v", "-o", f"{folder}/empty.so", f"{folder}/empty.c")
    named = [Path(word) for word in said.split() if re.fullmatch(GLIBC_PARTS, Path(word).name)]
    return [str(shutil.copy(part, folder)) for part in named if part.is_absolute()]


def allowed_symbols(library: str) -> dict[str, tuple[str, str, int]]:
    """Version, type and size of each symbol, in its newest version that is allowed."""
    found: dict[str, tuple[tuple[int, ...], str, str, int]] = {}
    with open(library, "rb") as file:
        elf = ELFFile(file)
        versions = elf.get_section_by_name(".gnu.version")
        definitions = elf.get_section_by_name(".gnu.version_d").iter_versions()
        names = {number["vd_ndx"]: next(texts).name for number, texts in definitions}
        for at, symbol in enumerate(elf.get_section_by_name(".dynsym").iter_symbols()):
            index = versions.get_symbol(at)["ndx"]
            if symbol["st_shndx"] in ("SHN_UNDEF", "SHN_ABS") or isinstance(index, str):
                continue
            version = names[index & 0x7FFF]
            family, _, digits = version.partition("_")
            if family not in NEWEST or not re.fullmatch(r"[\d.]+", digits):
                continue
            number = tuple(int(part) for part in digits.split("."))
            if number <= NEWEST[family] and number > found.get(symbol.name, ((),))[0]:
                found[symbol.name] = (number, version, symbol["st_info"]["type"], symbol["st_size"])
    return {name: entry[1:] for name, entry in found.items()}


def without_code(library: str, compiler: str, folder: Path) -> str:
    sections = {
        "STT_FUNC": (".text", "%function"),
        "STT_OBJECT": (".bss", "%object"),
        "STT_TLS": ('.section .tbss,"awT",%nobits', "%tls_object"),
    }
    lines, by_version = [], dict[str, list[str]]()
    for name, (version, kind, size) in allowed_symbols(library).items():
        section, type_name = sections[kind]
        size = max(size, 4)
        lines += [section, ".balign 16", f".globl {name}", f".type {name}, {type_name}"]
        lines += [f".size {name}, {size}", f"{name}: .zero {size}"]
        by_version.setdefault(version, []).append(name)
    file_name = "libstdc++.so.6"
    source, script = folder / "libstdc++.s", folder / "libstdc++.map"
    source.write_text("\n".join(lines) + "\n")
    script.write_text("".join(f"{v} {{ {'; '.join(n)}; }};\n" for v, n in by_version.items()))
    options = ("-shared", "-nostdlib", f"-Wl,-soname,{file_name}", f"-Wl,--version-script,{script}")
    output_of(compiler, *options, "-o", f"{folder}/{file_name}", str(source))
    return str(folder / file_name)


def main() -> None:
    version, compiler, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    machine = output_of(compiler, "-dumpmachine").strip()

    def file_of_compiler(name: str) -> str:
        return output_of(compiler, f"-print-file-name={name}").strip()

    # GCC's C++ library reads it to spare atomic counters; zero says that there are threads.
    single = folder / "single_threaded.c"
    single.write_text("char __libc_single_threaded;\n")
    output_of(compiler, "-xc", "-c", "-fPIC", "-o", f"{folder}/single_threaded.o", str(single))
    parts = [
        f"{folder}/single_threaded.o",
        without_code(file_of_compiler("libstdc++.so.6"), compiler, folder),
        *(file_of_compiler(name) for name in ("libstdc++.a", "libgcc_s.so.1", "libgcc.a")),
        *glibc_parts(version, machine, folder),
    ]
    print(";".join(parts))


if __name__ == "__main__":
    main()
