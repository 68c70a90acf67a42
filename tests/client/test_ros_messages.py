"""brace_msgs, built by ROS 2's own generators (Debian's rosidl and ament), read by a C++ program; and the bridge as a
Python package. Debian has neither std_msgs nor rclpy of ROS 2: std_msgs and geometry_msgs have stand-ins, and nothing
is sent."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import PROJECT

ROS = PROJECT / "tools" / "client" / "ros2"
GENERATORS = Path("/usr/share/rosidl_generator_cpp/cmake")
PACKAGE = """<?xml version="1.0"?>
<package format="3"><name>{name}</name><version>0.0.0</version><description>a stand-in</description>
<maintainer email="maintainer@example.com">Brace</maintainer><license>Apache-2.0</license>
<buildtool_depend>ament_cmake</buildtool_depend><member_of_group>rosidl_interface_packages</member_of_group>
<export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name})
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
{finds}
rosidl_generate_interfaces({name} {messages} {depends})
ament_package()
"""
DEFAULTS = {
    "rosidl_default_generators": "".join(
        f"find_package({name} REQUIRED)\n" for name in ("rosidl_cmake", "rosidl_generator_c", "rosidl_generator_cpp")
    ),
    "rosidl_default_runtime": "find_package(rosidl_runtime_c REQUIRED)\nfind_package(rosidl_runtime_cpp REQUIRED)\n",
}
READER_CMAKE = """cmake_minimum_required(VERSION 3.16)
project(reader CXX)
set(CMAKE_CXX_STANDARD 17)
find_package(ament_cmake REQUIRED)
find_package(brace_msgs REQUIRED)
add_executable(reader reader.cpp)
target_link_libraries(reader brace_msgs::brace_msgs__rosidl_generator_cpp)
"""
READER = """#include <cmath>
#include <cstdio>
#include "brace_msgs/msg/limb_load.hpp"
#include "brace_msgs/msg/limb_stiffness.hpp"
#include "brace_msgs/msg/limb_stiffness_in_space.hpp"
#include "brace_msgs/msg/stance.hpp"

int main()
{
    brace_msgs::msg::LimbStiffness k;
    brace_msgs::msg::LimbStiffnessInSpace space;
    brace_msgs::msg::LimbLoad load;
    k.header.frame_id = "limb_1";
    k.flags = brace_msgs::msg::LimbStiffness::FLAG_GAP_OPEN;
    k.play_tibia = brace_msgs::msg::LimbStiffness::PLAY_CROSSING;
    k.k_xx = 3964.0;
    space.lambda_1 = 0.5;
    load.buckling_factor = INFINITY;
    brace_msgs::msg::Stance stance;
    stance.feet.resize(2);
    stance.feet[1].force.z = 12.5;
    stance.feet[1].force_covariance[8] = 0.25;
    stance.carried.torque.y = -0.5;
    std::printf("%zu %.1f %.2f %.1f ", stance.feet.size(), stance.feet[1].force.z, stance.feet[1].force_covariance[8],
                stance.carried.torque.y);
    std::printf("%s %d %d %.0f %.1f %.0f\\n", k.header.frame_id.c_str(), k.flags, k.play_tibia, k.k_xx,
                space.lambda_1, load.buckling_factor);
}
"""


def run(folder: Path, *command: object) -> str:
    environment = {**os.environ, "AMENT_PREFIX_PATH": str(folder / "install")}
    done = subprocess.run([str(part) for part in command], env=environment, cwd=folder, capture_output=True,
                          text=True, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def build(folder: Path, source: Path, installs: bool = True) -> Path:
    """A package of a workspace, as colcon calls cmake for it."""
    made = folder / "build" / source.name
    places = f"{folder / 'install'};{folder / 'generators'}"
    run(folder, "cmake", "-G", "Ninja", "-S", source, "-B", made, f"-DCMAKE_INSTALL_PREFIX={folder / 'install'}",
        f"-DCMAKE_PREFIX_PATH={places}", "-DPython3_EXECUTABLE=/usr/bin/python3")
    run(folder, "cmake", "--build", made)
    if installs:
        run(folder, "cmake", "--install", made)
    return made


def stand_in(folder: Path, name: str, messages: dict[str, str], *needs: str) -> None:
    source = folder / name
    (source / "msg").mkdir(parents=True)
    for message, text in messages.items():
        (source / "msg" / f"{message}.msg").write_text(text)
    (source / "package.xml").write_text(PACKAGE.format(name=name))
    finds = "\n".join(f"find_package({need} REQUIRED)" for need in needs)
    depends = " ".join(("DEPENDENCIES", *needs)) if needs else ""
    files = " ".join(f'"msg/{message}.msg"' for message in messages)
    (source / "CMakeLists.txt").write_text(CMAKE.format(name=name, messages=files, finds=finds, depends=depends))
    build(folder, source)


@pytest.mark.minutes
@pytest.mark.skipif(not GENERATORS.is_dir(), reason="no ROS 2 generators here (Debian: rosidl-generator-c-cpp)")
def test_the_messages_are_built_and_read(tmp_path: Path) -> None:
    (tmp_path / "generators").mkdir()
    for name, text in DEFAULTS.items():
        (tmp_path / "generators" / f"{name}Config.cmake").write_text(text)
    stand_in(tmp_path, "builtin_interfaces", {"Time": "int32 sec\nuint32 nanosec\n"})
    header = "builtin_interfaces/Time stamp\nstring frame_id\n"
    stand_in(tmp_path, "std_msgs", {"Header": header}, "builtin_interfaces")
    vector = "float64 x\nfloat64 y\nfloat64 z\n"
    stand_in(tmp_path, "geometry_msgs", {"Vector3": vector, "Wrench": "Vector3 force\nVector3 torque\n"})
    build(tmp_path, ROS / "brace_msgs")
    reader = tmp_path / "reader"
    reader.mkdir()
    (reader / "CMakeLists.txt").write_text(READER_CMAKE)
    (reader / "reader.cpp").write_text(READER)
    assert run(tmp_path, build(tmp_path, reader, installs=False) / "reader") == (
        "2 12.5 0.25 -0.5 limb_1 8 4 3964 0.5 inf\n"
    )


def test_the_bridge_is_a_python_package(tmp_path: Path) -> None:
    """Installed as colcon does: `ros2 run` looks for programs in lib/brace_bridge."""
    source, place = tmp_path / "source", tmp_path / "place"
    run(tmp_path, "cp", "-r", ROS / "brace_bridge", source)
    how = ("install", "--prefix", place, "--single-version-externally-managed", "--record", tmp_path / "record")
    run(source, sys.executable, "setup.py", *how)
    assert list(place.glob("lib/python*/site-packages/brace_bridge/decode.py"))
    assert (place / "share" / "ament_index" / "resource_index" / "packages" / "brace_bridge").is_file()
    assert (place / "share" / "brace_bridge" / "package.xml").is_file()
    assert (place / "lib" / "brace_bridge" / "brace_bridge").is_file()
