"""What the whole core weighs on a controller: flash, RAM for one limb, deepest stack; from the compiler's figures."""

import re

from measure import object_of
from stack import worst_stack_bytes
from toolchain import BUILD, CORE, M3, M4F, Processor, flash_bytes, section_sizes, type_sizes
from versions import core_sources

NO_FPU_ONLY = ("planar_fixed", "loaded_fixed")  # headers for controllers without an FPU
HOST_ONLY = ("planar_batch", "chain_batch")
TWICE = ("chain",)  # the general path once more, with its arguments checked, for hosts
ONCE_FLASH = "flash, Cortex-M4F, every job in the plane and in space, each once"

JOBS = ("limb", "kinematics", "slope", "contact")  # of every limb, beside its K and, in the plane, its uncertainty
EQUAL_FLASH = "flash, Cortex-M4F, every job of a limb in its plane, base yielding equally"
ANY_FLASH = "flash, Cortex-M4F, every job of a limb in its plane, any base (the general path)"
SPACE_FLASH = "flash, Cortex-M4F, every job of a limb in space"

WATCHING = ("backlash", "gap_stiffness", "drift")  # what watches the limb; the estimator does without
LIMB_FLASH = ("flash, Cortex-M4F, every job in the plane, both paths to K, "
              "for a limb not known before its parameters come")
CORE_FLASH = "flash, Cortex-M4F, every function of the estimator: with the checked general path, which is for hosts"
PLANAR_RAM = "RAM, one limb: parameters and planar constants"
FIXED_RAM = "RAM, one limb: parameters and fixed-point constants"
SPATIAL_RAM = "RAM, one limb: parameters and spatial constants"
CORE_STACK = "stack, Cortex-M4F, the estimator's deepest public function"


def functions_of(header: str) -> tuple[str, ...]:
    """The functions that a header's text declares."""
    return tuple(re.findall(r"^[\w ]+[ *](brace_\w+)\(", header, re.MULTILINE))


def without_space(functions: tuple[str, ...]) -> tuple[str, ...]:
    """Those that a limb in its plane needs."""
    return tuple(name for name in functions if "_spatial" not in name)


def public_functions(headers_without: tuple[str, ...]) -> tuple[str, ...]:
    """Functions that the core's public headers declare, but for headers whose name starts with one of the given."""
    names: set[str] = set()
    for header in sorted((CORE / "include" / "brace").glob("*.h")):
        if not header.stem.startswith(headers_without):
            names.update(functions_of(header.read_text()))
    return tuple(sorted(names))


def _declared(headers: tuple[str, ...]) -> tuple[str, ...]:
    """The functions of some public headers, "name" without its ".h"."""
    return tuple(name for header in headers
                 for name in functions_of((CORE / "include" / "brace" / f"{header}.h").read_text()))


def limb_kinds() -> dict[str, tuple[str, ...]]:
    """Kinds of limbs -> all public functions that have a job there. A limb is of one of them,
    and links no other's K."""
    plane = without_space(_declared((*JOBS, "uncertainty")))
    return {
        EQUAL_FLASH: (*_declared(("planar",)), *plane),
        ANY_FLASH: (*_declared(("general",)), *plane),
        SPACE_FLASH: (*_declared(("spatial", *JOBS)),),
    }


def _weigh(name: str, functions: tuple[str, ...]) -> tuple[int, int, str]:
    """Flash on the Cortex-M4F of public functions and what they call [B], the deepest stack below any [B], and which
    function needs it."""
    objects = [object_of(source, M4F, ()) for source in core_sources()]
    flash = flash_bytes(objects, functions, BUILD / "images" / f"core_{name}.elf", M4F)
    deepest, needs = max((worst_stack_bytes(objects, function)[0], function) for function in functions)
    return flash, deepest, needs


def weigh_modules() -> dict[str, int]:
    """Source of the core -> its own code and constants on a Cortex-M4F [B]."""
    weights = {}
    for source in core_sources():
        if not source.stem.startswith(HOST_ONLY):
            sizes = section_sizes(object_of(source, M4F, ()))
            stored = (".text", ".rodata", ".data")
            weights[source.stem] = sum(size for name, size in sizes.items() if name.startswith(stored))
    return {name: weights[name] for name in sorted(weights, key=lambda name: -weights[name])}


def _deepest(function: str, processor: Processor) -> int:
    return worst_stack_bytes([object_of(source, processor, ()) for source in core_sources()], function)[0]


def weigh_core() -> dict[str, int]:
    """Name -> bytes; the names say what and on which controller."""
    estimator = (*NO_FPU_ONLY, *HOST_ONLY, *WATCHING)
    flash, deepest, needs = _weigh("with_fpu", public_functions(estimator))
    everything, deepest_of_all, needs_most = _weigh("everything", public_functions(HOST_ONLY))
    once, _, _ = _weigh("once", public_functions((*estimator, *TWICE)))
    limb_only, _, _ = _weigh("planar_limb", without_space(public_functions((*estimator, *TWICE, "spatial"))))
    kinds = {kind: _weigh(f"limb_{number}", functions)[0]
             for number, (kind, functions) in enumerate(limb_kinds().items())}
    sizes = type_sizes(("brace_limb_t", "brace_planar_t", "brace_planar_fixed_t", "brace_spatial_t"),
                       ("brace/limb.h", "brace/planar.h", "brace/planar_fixed.h", "brace/spatial.h"), M4F)
    limb = sizes["brace_limb_t"]
    return {
        **kinds,
        LIMB_FLASH: limb_only,
        ONCE_FLASH: once,
        CORE_FLASH: flash,
        "flash, Cortex-M4F, all of the core: fixed point, play and drift as well": everything,
        PLANAR_RAM: limb + sizes["brace_planar_t"],
        FIXED_RAM: limb + sizes["brace_planar_fixed_t"],
        SPATIAL_RAM: limb + sizes["brace_spatial_t"],
        "stack, Cortex-M4F, brace_planar_stiffness": _deepest("brace_planar_stiffness", M4F),
        "stack, Cortex-M4F, brace_planar_collapse": _deepest("brace_planar_collapse", M4F),
        "stack, Cortex-M3, brace_planar_fixed_stiffness": _deepest("brace_planar_fixed_stiffness", M3),
        f"{CORE_STACK} ({needs})": deepest,
        f"stack, Cortex-M4F, the deepest of all of the core ({needs_most})": deepest_of_all,
    }
