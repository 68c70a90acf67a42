"""`./dev bench`: what a K costs, side by side with its peers, on the same postures; PASS or MISS per limit.

Writes bench.json, bench.md, backlash.svg and loaded.svg into build/bench/report. docs/bench.md has the main tables by hand.
Exit codes: 0 every limit kept, 1 one missed, 4 something is missing here.
"""

import argparse
import json
import re
import sys
from pathlib import Path

BENCH = Path(__file__).resolve().parent
sys.path.insert(0, str(BENCH))

import backlash_report  # noqa: E402
import drift  # noqa: E402
import fetch  # noqa: E402
import flash_groups  # noqa: E402
import flood  # noqa: E402
import footprint  # noqa: E402
import loaded  # noqa: E402
import loaded_picture  # noqa: E402
import loaded_space  # noqa: E402
import postures  # noqa: E402
import tick_cost  # noqa: E402
import versions  # noqa: E402
from calibrate import calibrate  # noqa: E402
from emulate import build_plugin  # noqa: E402
from limits import Limits  # noqa: E402
from map_time import map_seconds  # noqa: E402
from measure import measure  # noqa: E402
from report import Bench, as_data, as_markdown, as_text  # noqa: E402
from throughput import measure_rates  # noqa: E402
from toolchain import BUILD, PREFIX, run  # noqa: E402
from weights import weigh_core, weigh_modules  # noqa: E402


def say(text: str) -> None:
    """A line of progress."""
    print(text, file=sys.stderr, flush=True)


def generate() -> Path:
    """bench_data.h and CasADi's C; gives the folder of the latter."""
    generated = BUILD / "generated"
    generated.mkdir(parents=True, exist_ok=True)
    (BUILD / "images").mkdir(parents=True, exist_ok=True)
    (generated / "bench_data.h").write_text(postures.header())
    run(["env", f"PYTHONPATH={fetch.casadi()}", sys.executable, BENCH / "peers" / "casadi_generate.py", generated])
    return generated


def tools() -> dict[str, str]:
    """Program -> version, for the record."""
    commands = {"arm-none-eabi-gcc": [PREFIX + "gcc", "--version"], "gcc": ["gcc", "--version"],
                "qemu-system-arm": ["qemu-system-arm", "--version"]}
    found = {name: re.search(r"\d+\.\d+(\.\d+)?", run(command).splitlines()[0]) for name, command in commands.items()}
    return {**{name: match[0] for name, match in found.items() if match},
            **{package.rpartition("==")[0]: package.rpartition("==")[2] for package in (fetch.CASADI, fetch.CMSIS_DSP)}}


def bench(out: Path) -> Bench:
    """The whole run; pictures go to `out`."""
    map_s = map_seconds()
    say("fetching peers and the plugin header (first time only)")
    generated = generate()
    plugin = build_plugin()
    calibrate(plugin)
    measured = []
    for version in [*versions.ours(), *versions.peers(generated)]:
        say(f"counting: {version.group}: {version.name}")
        measured.append(measure(version, plugin))
    say("K under a load, beside its peers")
    under_load = loaded.extra(generated, plugin)
    loaded_picture.draw(out / "loaded.svg")
    in_space_under_load = loaded_space.extra(plugin)
    say("host throughput")
    rates = measure_rates()
    say("weighing the core")
    weights = weigh_core()
    checks = Limits(measured, rates, weights, map_s).checks()
    say("backlash: histories, oracle, take-ups")
    plays = backlash_report.extra(out)
    say("the controller's tick: a million random ones")
    extras = (under_load, in_space_under_load, flash_groups.extra(), footprint.extra(), plays, drift.extra(plugin),
              flood.extra(), tick_cost.extra())
    return Bench(measured, rates, weights, map_s, weigh_modules(), checks, tools(), extras)


def main() -> int:
    """Run, print, write; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=BUILD / "report", help="folder of what is written")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    try:
        result = bench(out)
    except fetch.Missing as missing:
        say(f"bench: missing: {missing}")
        return 4
    except RuntimeError as error:
        say(f"bench: {error}")
        return 1
    print(as_text(result))
    (out / "bench.json").write_text(json.dumps(as_data(result), indent=1) + "\n")
    (out / "bench.md").write_text(as_markdown(result))
    missed = [check for check in result.all_checks if not check.passed]
    print(f"\n{len(result.all_checks) - len(missed)} limits kept, {len(missed)} missed; "
          f"written: bench.json, bench.md and pictures in {out}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
