"""What the whole core weighs on a controller: flash, RAM for one limb, deepest stack; from the compiler's figures."""

import re
from pathlib import Path

from measure import object_of
from stack import worst_stack_bytes
from toolchain import BUILD, M3, M4F, PREFIX, Processor, flash_bytes, run, section_sizes, type_sizes
from versions import core_sources

NO_FPU_ONLY = ("planar_fixed", "fixed_")  # stems of the sources for controllers without an FPU
HOST_ONLY = ("planar_batch",)

CORE_FLASH = "flash, Cortex-M4F, all of the core but the fixed-point path"
PLANAR_RAM = "RAM, one limb: parameters and planar constants"
FIXED_RAM = "RAM, one limb: parameters and fixed-point constants"
SPATIAL_RAM = "RAM, one limb: parameters and spatial constants"
CORE_STACK = "stack, Cortex-M4F, the deepest public function"


def public_functions(objects: list[Path]) -> tuple[str, ...]:
    """Global functions of the objects, sorted."""
    names = re.findall(r"^[0-9a-f]+ T (brace_\w+)$", run([PREFIX + "nm", "-g", "--defined-only", *objects]), re.MULTILINE)
    return tuple(sorted(set(names)))


def _is_for(source: Path, stems: tuple[str, ...]) -> bool:
    return source.stem.startswith(stems)


def _weigh(name: str, sources: list[Path], processor: Processor) -> tuple[int, int, str]:
    """Flash [B] of all public functions, the deepest stack below any [B], and which one needs it."""
    objects = [object_of(source, processor, ()) for source in sources]
    functions = public_functions(objects)
    flash = flash_bytes(objects, functions, BUILD / "images" / f"core_{name}.elf", processor)
    deepest, needs = max((worst_stack_bytes(objects, function)[0], function) for function in functions)
    return flash, deepest, needs


def weigh_modules() -> dict[str, int]:
    """Source of the core -> its own code and constants on a Cortex-M4F [B]."""
    weights = {}
    for source in core_sources():
        if not _is_for(source, HOST_ONLY):
            sizes = section_sizes(object_of(source, M4F, ()))
            weights[source.stem] = sum(size for name, size in sizes.items() if name.startswith((".text", ".rodata", ".data")))
    return {name: weights[name] for name in sorted(weights, key=lambda name: -weights[name])}


def _deepest(function: str, processor: Processor, sources: list[Path]) -> int:
    return worst_stack_bytes([object_of(source, processor, ()) for source in sources], function)[0]


def weigh_core() -> dict[str, int]:
    """Name -> bytes; the names say what and on which controller."""
    on_limb = [source for source in core_sources() if not _is_for(source, HOST_ONLY)]
    with_fpu = [source for source in on_limb if not _is_for(source, NO_FPU_ONLY)]
    flash, deepest, needs = _weigh("with_fpu", with_fpu, M4F)
    everything, _, _ = _weigh("everything", on_limb, M4F)
    sizes = type_sizes(("brace_limb_t", "brace_planar_t", "brace_planar_fixed_t", "brace_spatial_t"),
                       ("brace/limb.h", "brace/planar.h", "brace/planar_fixed.h", "brace/spatial.h"), M4F)
    limb = sizes["brace_limb_t"]
    return {
        CORE_FLASH: flash,
        "flash, Cortex-M4F, the fixed-point path as well": everything,
        PLANAR_RAM: limb + sizes["brace_planar_t"],
        FIXED_RAM: limb + sizes["brace_planar_fixed_t"],
        SPATIAL_RAM: limb + sizes["brace_spatial_t"],
        "stack, Cortex-M4F, brace_planar_stiffness": _deepest("brace_planar_stiffness", M4F, with_fpu),
        "stack, Cortex-M4F, brace_planar_collapse": _deepest("brace_planar_collapse", M4F, with_fpu),
        "stack, Cortex-M3, brace_planar_fixed_stiffness": _deepest("brace_planar_fixed_stiffness", M3, on_limb),
        f"{CORE_STACK} ({needs})": deepest,
    }
