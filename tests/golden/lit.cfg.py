# How lit runs the golden tests: every file with a RUN line in this folder. `rtsl-opt`, `rtslc` and
# `FileCheck` on RUN lines are the programs of the build that is tested.
import os

import lit.formats

config.name = "golden"
config.test_format = lit.formats.ShTest(execute_external=False)
config.suffixes = [".mlir", ".rtsl", ".test"]
config.excludes = ["Inputs"]
config.test_source_root = os.path.dirname(__file__)
config.test_exec_root = config.binary_root

for name, path in config.programs.items():
    if name == "rtsl-opt":
        # Passes that cut functions at their traces also read the functions that these call. The
        # compiler runs them one after the other; as passes on functions they would run at once.
        path += " --mlir-disable-threading"
    config.substitutions.append((r"(?<![\w/.-])" + name + r"(?![\w/.-])", path))
config.substitutions.append(("%root", os.path.dirname(os.path.dirname(config.test_source_root))))
config.environment["FILECHECK_OPTS"] = "--dump-input=fail"
# A stack trace with names, where a tool crashes.
config.environment["LLVM_SYMBOLIZER_PATH"] = os.path.join(config.llvm_tools, "llvm-symbolizer")
