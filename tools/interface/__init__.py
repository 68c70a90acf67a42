"""The generator: firmware/interface/dictionary.toml in; C tables, Python names and the page of keys out.

Run it from tools/ as `../.venv/bin/python -m interface`; with --check it writes nothing and fails on drift.
"""
