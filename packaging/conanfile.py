"""The core as a Conan package: conan create . (with --profile:host for another machine)."""

from conan import ConanFile
from conan.tools.cmake import CMake, cmake_layout
from conan.tools.files import copy


class BraceCore(ConanFile):
    name = "brace-core"
    version = "@version@"
    description = "@summary@"
    author = "@author@ <@email@>"
    url = "@source@"
    homepage = "@homepage@"
    license = "Apache-2.0"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    generators = "CMakeToolchain"
    exports_sources = "CMakeLists.txt", "src/*", "LICENSE"
    languages = "C"

    def layout(self):
        cmake_layout(self)

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, self.package_folder)

    def package_info(self):
        self.cpp_info.libs = ["brace_core"]
        self.cpp_info.system_libs = ["m"]
        self.cpp_info.set_property("cmake_file_name", "brace")
        self.cpp_info.set_property("cmake_target_name", "brace::core")
        self.cpp_info.set_property("pkg_config_name", "brace-core")
