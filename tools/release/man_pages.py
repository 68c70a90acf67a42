"""Man pages, made from the command line's parsers: brace.1 and one for each command, brace-k.1 and so on."""

from __future__ import annotations

import argparse
import os
import re
import time
from pathlib import Path

from argparse_manpage.manpage import Manpage

from brace.cli.command_line import build_parser

# man takes a line of text that begins with a point or an apostrophe for a request that it does not know, and leaves the
# line out.
_REQUEST_BY_CHANCE = re.compile(r"^(?:\.(?!(?:TH|SH|SS|PP|TP|BR?|sp|nf|fi|br)\b)|')", re.MULTILINE)
ABOUT = {"project_name": "Brace", "manual_title": "Brace", "manual_section": "1"}


def man_pages(version: str) -> dict[str, str]:
    """Names and texts. The date in them is SOURCE_DATE_EPOCH's, the day in UTC wherever they are made."""
    os.environ["TZ"] = "UTC"
    time.tzset()
    parser = build_parser()
    commands = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
    about = {choice.dest: choice.help or "" for choice in commands._choices_actions}
    pages = {}
    for name, command in commands.choices.items():
        command.prog = f"brace {name}"
        pages[f"brace-{name}.1"] = _page(command, f"brace-{name}", about.get(name, ""), version)
    listed = [f"brace-{name}(1): {about.get(name, '')}" for name in commands.choices]
    parser._actions.remove(commands)
    for group in parser._action_groups:
        if commands in group._group_actions:
            group._group_actions.remove(commands)
    parser.usage = "brace COMMAND [options]"
    parser.epilog = "\n\n".join(["Commands:", *listed, parser.epilog or ""])
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    pages["brace.1"] = _page(parser, "brace", "stiffness at the tip of a climbing robot's limb", version)
    return pages


def _page(parser: argparse.ArgumentParser, prog: str, about: str, version: str) -> str:
    page = Manpage(parser, {**ABOUT, "description": about, "version": version})
    page.prog = prog
    return _REQUEST_BY_CHANCE.sub(r"\\&\g<0>", str(page))


def write(folder: Path, version: str) -> None:
    """Writes all pages into a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in man_pages(version).items():
        (folder / name).write_text(text)
