"""For catkin and for pip: package.xml says what this is, requirements.txt what it needs."""

import os
from glob import glob
from pathlib import Path
from xml.etree import ElementTree

from setuptools import Extension, find_packages, setup

try:
    from numpy import get_include
except ImportError:  # catkin, which only asks what packages there are, may run without NumPy
    get_include = str

manifest = ElementTree.parse("package.xml")

setup(
    name=manifest.findtext("name"),
    version=manifest.findtext("version"),
    description=manifest.findtext("description"),
    license=manifest.findtext("license"),
    packages=find_packages("src"),
    package_dir={"": "src"},
    package_data={"youbot_kinematics": ["*.pyi"]},
    ext_modules=[
        Extension(
            "youbot_kinematics.formulas",
            sources=sorted(glob("src/formulas/*.c")),
            depends=glob("src/formulas/*.h"),
            include_dirs=[get_include()],
            # No formula reads errno. Else portable: no fast math, no instructions of one machine
            extra_compile_args=["-std=c99", "-O3", "-fno-math-errno"] if os.name == "posix" else [],
        )
    ],
    data_files=[
        (f"share/youbot_kinematics/{folder}", sorted(glob(f"{folder}/*")))
        for folder in ("bags", "config", "launch", "page", "urdf")
    ],
    install_requires=Path("requirements.txt").read_text().splitlines(),
    extras_require={
        "plot": ["matplotlib>=3.6"],
        "report": ["plotly", "urdf-parser-py"],
        "kdl": ["urdf-parser-py"],  # and PyKDL, which no wheel has: Debian's python3-pykdl
    },
    python_requires=">=3.8",
)
