"""Every Python process below a test imports this: it puts the mutant in place of its file, or counts lines.

BRACE_MUTANT names the file of the tools that is replaced, BRACE_MUTANT_TEXT the file with its new text. Each process
that runs the new text writes a line to BRACE_MUTANT_SEEN. COVERAGE_PROCESS_START is coverage's own: count lines.
"""

import os


def _swap(file: str, text: str, seen: str) -> None:
    from importlib.machinery import SourceFileLoader
    from types import CodeType

    file = os.path.realpath(file)
    as_it_is = SourceFileLoader.get_code

    def get_code(self: SourceFileLoader, fullname: str) -> CodeType | None:
        path = self.get_filename(fullname)
        if os.path.basename(path) != os.path.basename(file) or os.path.realpath(path) != file:
            return as_it_is(self, fullname)
        with open(seen, "a") as out:
            out.write(f"{os.getpid()} {fullname}\n")
        with open(text, "rb") as new:
            return compile(new.read(), path, "exec", dont_inherit=True)

    SourceFileLoader.get_code = get_code  # type: ignore[method-assign, assignment]


if "BRACE_MUTANT" in os.environ:
    _swap(os.environ["BRACE_MUTANT"], os.environ["BRACE_MUTANT_TEXT"], os.environ["BRACE_MUTANT_SEEN"])
elif os.environ.get("BRACE_MUTANT_CONTEXT"):
    import signal

    import coverage

    coverage.process_startup()  # type: ignore[attr-defined]  # mypy takes our own coverage.py for it
    # coverage handles SIGTERM in this process. A forked process must end at SIGTERM, so the system handles it there.
    os.register_at_fork(after_in_child=lambda: signal.signal(signal.SIGTERM, signal.SIG_DFL))
