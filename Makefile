# A thin cover over CMake's presets: dev, release, asan.
#
#   make demo     install what is missing, build, render examples/glass
#   make check    install what is missing, build, run every test
#   make deep     run in full what `make check` samples: thousands of random programs, all of printed C++, ...
#   make golden   renew the expected output of the golden tests (then read the difference)
#   make bench    build and run the benchmarks
#   make fuzz     feed mutated inputs to the front end for TIME seconds (TARGET=scene: to the reader of scenes)
#   make mutations break the continuation passes, and see the tests notice
#   make memory   render the examples under MemorySanitizer
#   make numerics run the stiff and extreme cases in full, and renew their table in docs/numerics.md

PRESET ?= release
BUILD := build/$(PRESET)
JOBS ?= $(shell nproc)

# The heap in large pages, where the kernel allows it: compilers take 6 to 17 % less time.
export GLIBC_TUNABLES ?= glibc.malloc.hugetlb=1

.PHONY: demo check deep build configure dependencies golden bench fuzz mutations memory numerics format install clean

demo: configure
	cmake --build --preset $(PRESET) -j $(JOBS) --target rtslc
	$(BUILD)/bin/rtslc render examples/glass/scene.json -o $(BUILD)/glass.png
	@echo "the picture is $(BUILD)/glass.png"

# One test more than there are cores: tests wait for files, signals and each other's processes.
check: build
	cd $(BUILD) && ctest --output-on-failure -j$$(($(JOBS) + 1)); status=$$?; \
	grep '^skipped: ' Testing/Temporary/LastTest.log; exit $$status

deep: build
	tests/deep $(BUILD)

build: configure
	cmake --build --preset $(PRESET) -j $(JOBS)

configure: dependencies
	cmake --preset $(PRESET) $(CMAKE_FLAGS)

dependencies:
ifndef SKIP_DEPENDENCIES
	@scripts/install-dependencies
endif

golden: build
	tests/golden/update $(BUILD)
	tests/language/renew $(BUILD)

bench: build
	cmake --build --preset $(PRESET) --target bench

TIME ?= 60
TARGET ?= front-end
fuzz: dependencies
	cmake --preset fuzz $(CMAKE_FLAGS)
	cmake --build --preset fuzz -j $(JOBS)
	tests/fuzz/run build/fuzz $(TARGET) $(TIME)

mutations: build
	tests/mutations/run $(BUILD)

memory: build
	tests/memory/run $(BUILD)

numerics: build
	tests/numerics/robustness/table $(BUILD)

format:
	scripts/check-format --fix

install: build
	cmake --install $(BUILD)

clean:
	rm -rf build
