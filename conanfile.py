"""Conan 2 recipe: conan create ."""
import os

from conan import ConanFile
from conan.tools.files import copy


class Textplane(ConanFile):
    name = "textplane"
    version = "0.1.0"
    license = "BSD-3-Clause"
    description = "SIMD geometry and photometry kernels for planar text features"
    topics = ("slam", "simd", "computer-vision", "header-only")
    package_type = "header-library"
    settings = "os", "compiler", "build_type", "arch"
    exports_sources = "LICENSE", "include/*"
    no_copy_source = True

    def requirements(self):
        self.requires("eigen/[>=3.3 <6]", transitive_headers=True)

    def package_id(self):
        self.info.clear()  # Headers: one package for all settings.

    def package(self):
        copy(self, "*.hpp", os.path.join(self.source_folder, "include"), os.path.join(self.package_folder, "include"))
        copy(self, "*.inl", os.path.join(self.source_folder, "include"), os.path.join(self.package_folder, "include"))
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.bindirs = []
        self.cpp_info.libdirs = []
        self.cpp_info.set_property("cmake_file_name", "textplane")
        self.cpp_info.set_property("cmake_target_name", "textplane::textplane")
        self.cpp_info.set_property("pkg_config_name", "textplane")
        self.cpp_info.requires = ["eigen::eigen"]
