# SPDX-License-Identifier: GPL-3.0-or-later
# DilatedDEM: make [all|demo|check|verify|bench|lint|install|uninstall|deb|clean] [SAN=address,undefined]
include config.mk

B     = build$(if $(SAN),/san)
TOOLS = voronoi-ice struct-import dem-solve loadstats arc-path ice-view pack block-cut
FLAGS = $(OPT) -g $(FLOAT) -fopenmp -Ilib -MMD -MP $(if $(SAN),-fsanitize=$(SAN) -fno-omit-frame-pointer -fno-sanitize-recover=all)
CCALL  = $(CC) -std=c17 -D_POSIX_C_SOURCE=200809L $(CWARN) $(FLAGS) $(CFLAGS)
CXXALL = $(CXX) -std=c++17 $(WARN) $(FLAGS) $(CXXFLAGS)
LIBS  = -Wl,--as-needed -lccd -lgsl -lgslcblas -linih -lz -lm -ldl
CGAL  = -lstdc++ -lgmp -lmpfr
# What draws is built where the headers are: OpenGL by libepoxy and EGL (pictures, films), SDL2 (the window).  Without
# them ice-view reads and converts, and says which package is missing.
has = $(shell echo '\#include <$1>' | $(CC) -E -x c - >/dev/null 2>&1 && echo yes)
GL  := $(call has,epoxy/egl.h)
SDL := $(if $(GL),$(call has,SDL2/SDL.h))
ifeq ($(GL),)
$(info ice-view: built without pictures, epoxy/egl.h is not there (packages libepoxy-dev libegl-dev))
else ifeq ($(SDL),)
$(info ice-view: built without its window, SDL2/SDL.h is not there (package libsdl2-dev))
endif

# The plug-in for an NVIDIA card, where nvcc is: GPU=0 leaves it out, GPU=1 insists.  Nothing else needs nvcc.
NVCC := $(or $(shell command -v nvcc 2>/dev/null),$(wildcard /usr/local/cuda/bin/nvcc))
GPU  ?= $(if $(NVCC),1,0)
ifeq ($(GPU)$(NVCC),1)
$(error GPU=1: there is no nvcc, of the package nvidia-cuda-toolkit or in /usr/local/cuda/bin)
endif
PLUGIN = $(if $(SAN),,$(if $(filter 1,$(GPU)),$B/lib/libfloe-cuda.so))
# Code for cards of 2018, 2020 and 2022 on, and for later ones as text that their driver compiles.
CARDS  = -gencode arch=compute_75,code=sm_75 -gencode arch=compute_80,code=sm_80 -gencode arch=compute_90,code=[sm_90,compute_90]
NVALL  = $(NVCC) -std=c++17 -O3 -fmad=false -Xcompiler -ffp-contract=off,-fPIC -Ilib -x cu

LIBOBJ   = $(patsubst %.c,$B/%.o,$(filter-out $(if $(GL),,lib/view/gl_%.c),$(wildcard lib/*/*.c)))
SHIMOBJ  = $(patsubst %.cpp,$B/%.o,$(wildcard lib/shim/*.cpp))
SHIM     = $B/libfloe-shim.a
SUPPORT  = $B/libsupport.a
HELPOBJ  = $(patsubst %.c,$B/%.o,$(wildcard tests/support/*.c))
test_of  = $(patsubst tests/$1/%.c,$B/tests/$1/%,$(wildcard tests/$1/*.c))
TESTS    = $(foreach k,unit prop fuzz verify bench,$(call test_of,$k))

all: $(TOOLS:%=$B/bin/%) $(PLUGIN)
$B/lib/libfloe-cuda.so: lib/gpu/cuda.cu $(wildcard lib/gpu/*.h lib/*/*_kernel.h) lib/law/tangent.h lib/law/damping.h lib/law/rolling.h
	@mkdir -p $(@D)
	$(NVALL) -shared -cudart static $(CARDS) $< -o $@
tests: all $(TESTS)

$B/%.o: %.c
	@mkdir -p $(@D)
	$(CCALL) -c $< -o $@
# CGAL's exact predicates switch the rounding mode.  Debug information would add half to the compile time of its
# templates and take twenty times the space.  -O1 takes 0.8 of the time of -O2; the planar file is hot and keeps -O2.
$(SHIMOBJ): CXXFLAGS += -frounding-math -g0 -Wno-maybe-uninitialized
$B/lib/shim/cgal_s%.o: OPT := $(OPT:-O2=-O1)
# Loops over the bytes of pictures, of which -O3 makes vectors.
$B/lib/view/edge_smoothing.o: OPT := $(OPT:-O2=-O3)
$B/%.o: %.cpp
	@mkdir -p $(@D)
	$(CXXALL) -c $< -o $@
$B/libfloe.a: $(LIBOBJ)
	@rm -f $@
	ar rcs $@ $^
$B/libfloe-shim.a: $(SHIMOBJ)
	@rm -f $@
	ar rcs $@ $^
$(SUPPORT): $(HELPOBJ)
	@rm -f $@
	ar rcs $@ $^

# What --version says of the sources: linked into the programs alone, so that a commit builds nothing else anew.
$B/source.c: FORCE
	@mkdir -p $(@D)
	@printf '#include "base/tool.h"\nconst char fl_tool_source[] = "%s";\n' "$$(sh share/packaging/source.sh)" >$@.new
	@cmp -s $@.new $@ && rm $@.new || mv $@.new $@
$B/source.o: $B/source.c
	@$(CCALL) -c $< -o $@
FORCE:

# A program is the .c files of its folder on the two libraries; what it does not use is not linked.
VIEW = $(if $(GL),,%/shot.c) $(if $(SDL),,%/window.c)
$B/tools/ice-view/%.o: CFLAGS += $(if $(GL),-DFL_HAVE_GL) $(if $(SDL),-DFL_HAVE_WINDOW)
$B/bin/ice-view: LIBS += $(if $(GL),-lepoxy) $(if $(SDL),-lSDL2)
define tool
$B/bin/$1: $(patsubst %.c,$B/%.o,$(filter-out $(VIEW),$(wildcard tools/$1/*.c))) $B/source.o $B/libfloe-shim.a $B/libfloe.a
	@mkdir -p $$(@D)
	$$(CCALL) $$(LDFLAGS) -Wl,--start-group $$^ -Wl,--end-group $$(LIBS) $$(CGAL) -o $$@
endef
$(foreach t,$(TOOLS),$(eval $(call tool,$t)))
# dem-solve for other vectors than those of the machine, for the ladder of bench/.
$B/bench/plain.o: WIDTH = 0
$B/bench/avx2.o: WIDTH = 1u<<10
$B/bench/%.o: bench/vectors.c
	@mkdir -p $(@D)
	$(CCALL) -D'WIDTH=$(WIDTH)' -c $< -o $@
$B/bench/dem-solve-%: $B/bench/%.o $(patsubst %.c,$B/%.o,$(wildcard tools/dem-solve/*.c)) $(SHIM) $B/libfloe.a
	$(CCALL) $(LDFLAGS) -Wl,--start-group $^ -Wl,--end-group $(LIBS) $(CGAL) -o $@
$B/tests/%: $B/tests/%.o $(SUPPORT) $(SHIM) $B/libfloe.a
	$(CCALL) $(LDFLAGS) -Wl,--start-group $^ -Wl,--end-group -lcmocka $(LIBS) $(CGAL) -o $@
$B/tests/%.o $(HELPOBJ): CFLAGS += -Itests

# setup installs what is missing (Debian, Ubuntu) or names it; then the real work runs in a second make.
setup:
	@sh share/setup.sh
demo check verify bench: setup
	@$(MAKE) --no-print-directory -j$$(getconf _NPROCESSORS_ONLN) run-$@
run-demo: all
	@$(MAKE) --no-print-directory -C share/examples/cylinder BIN=$(CURDIR)/$B/bin OUT=$(CURDIR)/$B/demo demo
run-check: $(if $(SAN),,readers)
run-check run-verify run-bench: tests
	@sh tests/run.sh $(@:run-%=%) $B
# The readers once more, under the sanitizers: check replays the corpora of tests/fuzz with them.  CGAL stays as it is.
readers: $(SHIM)
	@echo 'int main(void) { return 0; }' >$B/probe.c
	@if $(CC) -fsanitize=address,undefined $B/probe.c -o $B/probe && $B/probe; then \
		$(MAKE) --no-print-directory SAN=address,undefined OPT=-O0 SHIM=$(SHIM) corpora; \
	else echo "readers: this compiler has no sanitizers, corpora are replayed without them" >&2; fi
corpora: $(call test_of,fuzz)
# Cost beside error over scenes and settings; FLOE_QUICK=1 takes a minute or two.
WIDTHS = $(if $(filter x86_64,$(shell uname -m)),$B/bench/dem-solve-plain $B/bench/dem-solve-avx2)
run-bench: $(WIDTHS)
ladder: all $(WIDTHS)
	@sh bench/ladder.sh $B
# On a machine with a card: bits, and times, into bench/results/gpu.tsv.
gpu-check gpu-bench: all
	@sh bench/gpu.sh $(@:gpu-%=%) $B
golden-update: all
	@sh tests/run.sh update $B
lint:
	@sh tests/lint/lint.sh

# Programs are stripped; STRIP= keeps their symbols.  What runs of the examples left in out/ is not installed.
STRIP = -s
SHARED = $(DESTDIR)$(PREFIX)/share
PAGES  = $(foreach s,1 5 7,$(addprefix man$s/,$(notdir $(wildcard tools/*/*.$s share/man$s/*.$s))))
install: all
	install -d $(DESTDIR)$(PREFIX)/bin $(foreach s,1 5 7,$(SHARED)/man/man$s) $(SHARED)/dilateddem $(SHARED)/doc/dilateddem \
		$(SHARED)/bash-completion/completions $(SHARED)/zsh/site-functions
	install $(STRIP) $(TOOLS:%=$B/bin/%) $(DESTDIR)$(PREFIX)/bin
	$(if $(PLUGIN),install -D -m 644 $(PLUGIN) $(DESTDIR)$(PREFIX)/lib/libfloe-cuda.so)
	install -m 644 $(wildcard tools/*/*.1) $(SHARED)/man/man1
	install -m 644 $(wildcard share/man5/*.5) $(SHARED)/man/man5
	install -m 644 $(wildcard share/man7/*.7) $(SHARED)/man/man7
	install -m 644 README.md CHANGES.md COPYING $(wildcard share/doc/*.md share/doc/*.png) $(SHARED)/doc/dilateddem
	tar -C share --exclude=out --exclude=__pycache__ -cf - materials examples python | tar -C $(SHARED)/dilateddem -xf -
	install -m 644 share/packaging/smoke.sh $(SHARED)/dilateddem
	sed 's/COMMANDS/$(TOOLS)/' share/completion/dilateddem.bash >$(SHARED)/bash-completion/completions/dem-solve
	cd $(SHARED)/bash-completion/completions && for t in $(filter-out dem-solve,$(TOOLS)); do ln -sf dem-solve $$t; done
	sed 's/COMMANDS/$(TOOLS)/' share/completion/_dilateddem >$(SHARED)/zsh/site-functions/_dilateddem
uninstall:
	rm -f $(TOOLS:%=$(DESTDIR)$(PREFIX)/bin/%) $(DESTDIR)$(PREFIX)/lib/libfloe-cuda.so $(PAGES:%=$(SHARED)/man/%) $(SHARED)/zsh/site-functions/_dilateddem \
		$(TOOLS:%=$(SHARED)/bash-completion/completions/%)
	rm -rf $(SHARED)/dilateddem $(SHARED)/doc/dilateddem
deb:
	@sh share/packaging/deb.sh build
clean:
	rm -rf build

.PHONY: all FORCE ladder tests readers corpora setup demo check verify bench run-demo run-check run-verify run-bench gpu-check gpu-bench golden-update lint install uninstall deb clean
.SECONDARY:
-include $(wildcard $B/*/*/*.d $B/*/*/*/*.d)
