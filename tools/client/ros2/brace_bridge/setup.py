from setuptools import setup

NAME = "brace_bridge"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + NAME]),
        ("share/" + NAME, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": ["brace_bridge = brace_bridge.node:main"]},
)
