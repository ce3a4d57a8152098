# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes anticrack.v1, the API's messages and services, from the proto files when the package is built."""
import os
import pathlib
import shutil
import subprocess

from setuptools import setup
from setuptools.command.build_py import build_py

HERE = pathlib.Path(__file__).resolve().parent
PROTO = pathlib.Path(os.environ.get("ANTICRACK_PROTO", HERE.parents[1] / "proto"))


class BuildWithApi(build_py):
    def get_package_dir(self, package: str) -> str:
        return "anticrack" if package == "anticrack.v1" else super().get_package_dir(package)

    def find_package_modules(self, package: str, package_dir: str) -> list:
        return [] if package == "anticrack.v1" else super().find_package_modules(package, package_dir)

    def run(self) -> None:
        super().run()
        plugin = shutil.which("grpc_python_plugin")
        if not plugin or not shutil.which("protoc"):
            raise SystemExit("protoc or grpc_python_plugin is missing; install protobuf-compiler and "
                             "protobuf-compiler-grpc")
        made = pathlib.Path(self.build_lib)
        protos = [str(path.relative_to(PROTO)) for path in sorted(PROTO.glob("anticrack/v1/*.proto"))]
        described = made / "anticrack/v1/comments.desc"  # the modules have no comments
        subprocess.run(["protoc", f"--plugin=protoc-gen-grpc_python={plugin}", f"-I{PROTO}", f"--python_out={made}",
                        f"--pyi_out={made}", f"--grpc_python_out={made}", "--include_source_info",
                        f"--descriptor_set_out={described}", *protos], check=True)
        (made / "anticrack/v1/__init__.py").write_text("", encoding="utf-8")


setup(cmdclass={"build_py": BuildWithApi})
