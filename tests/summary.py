"""Add up the JUnit reports of a test run and close with one line that says how it went.

usage: summary.py REPORT_FOLDER [STAGE ...]    STAGE: a stage whose runner did not exit with 0
"""

import pathlib
import sys
import xml.etree.ElementTree


def reason_of(case: xml.etree.ElementTree.Element) -> str:
    """Why a test was skipped, in one line."""
    skipped = case.find("skipped")
    text = "" if skipped is None else skipped.get("message") or skipped.text or ""
    return " ".join(text.split()) or "no reason given"


def main(folder: str, failed_stages: list[str]) -> int:
    """Print failures and what was skipped and why, one a line, then 'N passed, N failed, N skipped';
    0 only if all is well."""
    passed = failed = skipped = 0
    reported: set[str] = set()
    for report in sorted(pathlib.Path(folder).glob("*.xml")):
        before = failed
        for case in xml.etree.ElementTree.parse(report).iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                failed += 1
                print(f"failed: {report.stem}: {case.get('classname', '')} {case.get('name')}")
            elif case.find("skipped") is not None or case.get("status") == "disabled":
                skipped += 1
                print(f"skipped: {report.stem}: {case.get('name')}: {reason_of(case)}")
            else:
                passed += 1
        if failed > before:
            reported.add(report.stem)
    for stage in failed_stages:
        if stage not in reported:
            failed += 1
            print(f"failed: {stage}: the runner stopped with an error and no failed test in its report")
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
