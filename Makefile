# holonom: `make` builds, `make run` starts the page, `make test` runs the whole suite, `make help` lists the rest.

.DEFAULT_GOAL := all
.SUFFIXES:
.DELETE_ON_ERROR:
.SECONDARY:
SHELL := /bin/sh

COMMA := ,
# V=1 shows the commands
Q   := $(if $(V),,@)
say  = $(if $(V),,@echo '$(if $(filter release,$(VARIANT)),,[$(VARIANT)] )$(1)')

# all processors, unless make was told how many
JOBS = $(if $(findstring jobserver,$(MAKEFLAGS)),,-j$(shell nproc))

VERSION := $(shell sed -n 's/^.define HN_VERSION "\(.*\)"/\1/p' server/build.h)
PREFIX ?= /usr/local
PORT   ?= 8080

# ---- layers: each names what it may include, lowest last; tests link the same list ----------------------------
LAYERS := base linalg expr export scene import dynamics formulations integrators study render session server
NEEDS_base        :=
NEEDS_linalg      := base
NEEDS_expr        := base
NEEDS_export      := expr base
NEEDS_scene       := expr base
NEEDS_import      := scene expr linalg base
NEEDS_dynamics    := scene expr linalg base
NEEDS_formulations := dynamics $(NEEDS_dynamics)
NEEDS_integrators := formulations $(NEEDS_formulations)
NEEDS_study       := integrators $(NEEDS_integrators)
NEEDS_render      := dynamics $(NEEDS_dynamics)
NEEDS_session     := export import render study $(NEEDS_study)
NEEDS_server      := session $(NEEDS_session)

# ---- rooms of the larger layers, lowest first: room:rooms below it that it may include -------------------------
ROOMS_dynamics     := compile: evaluate:compile assembly:compile,evaluate analyse:compile,evaluate \
                      reactions:compile,evaluate
ROOMS_formulations := ground: chart:ground rows:ground,chart list:ground,chart,rows
ROOMS_integrators  := step: explicit:step implicit:step constrained:step external:step \
                      list:step,explicit,implicit,constrained,external method:step,list
ROOMS_study        := spectrum: stepping: ensemble:stepping incidents:stepping run:spectrum,stepping,incidents \
                      truth:stepping,incidents,run budget:stepping,incidents,run \
                      stability:spectrum,stepping,incidents,run cost:stepping,incidents,run,truth
ROOMS_session      := style: verdict: store: model:store job:model compare:store,model references:store,model face:model export:model \
                      precision:style,store,model,job,compare,references \
                      budgets:style,store,model,job,references,precision \
                      stability:store,model,job,references,precision \
                      extreme:style,store,model,job,compare,references,precision \
                      report:style,store,model,job,compare,references,precision,budgets,stability,extreme \
                      kinds:job,model,references,precision,budgets,stability,extreme,report
# the layer server is three parts, two of them with rooms; what lies in server/ itself is open to all of them
ROOMS_server       := program: terminal: lesson:terminal grade/parts:terminal grade:grade/parts,lesson class:grade,grade/parts,program \
                      http/ground: http/request:http/ground http/live:http/ground,http/request \
                      http/studies:http/ground,http/request http/runs:http/ground,http/request \
                      http/routes:grade,grade/parts,lesson,http/ground,http/request,http/live,http/studies,http/runs \
                      cli/shell:terminal tui:terminal,lesson,grade,grade/parts,cli/shell \
                      cli/commands:class,grade,grade/parts,lesson,cli/shell,http/ground,http/request,http/routes,terminal,tui \
                      cli/study:terminal,cli/shell cli:program,terminal,grade,grade/parts,cli/shell :cli

# ---- variants: each has its own folder under build/ -----------------------------------------------------------
VARIANT ?= release
CC_release := gcc
CC_asan    := gcc
CC_tsan    := gcc
CC_gcc     := gcc
CC_clang   := clang
CC_fuzz    := clang
FLAGS_release := -O2 -g
FLAGS_asan    := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
FLAGS_tsan    := -O1 -g -fsanitize=thread -fno-omit-frame-pointer
FLAGS_gcc     := -O2 -Werror
FLAGS_clang   := -O2 -Werror
FLAGS_fuzz    := -O1 -g -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow -fno-sanitize-recover=all -fno-omit-frame-pointer

CC       := $(CC_$(VARIANT))
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wvla -Wdouble-promotion -Wstrict-prototypes \
            -Wmissing-prototypes -Wconversion -Wno-sign-conversion -Werror=implicit-function-declaration
# no fast-math and no fused multiply-add: a build must give the same bits everywhere
CFLAGS   := -std=c17 $(WARNINGS) -ffp-contract=off $(FLAGS_$(VARIANT)) -pthread
CPPFLAGS := -D_DEFAULT_SOURCE -isystem /usr/include/libxml2 -isystem /usr/include/suitesparse -MMD -MP
LDFLAGS  := $(FLAGS_$(VARIANT)) -pthread -Wl,--as-needed
LDLIBS   := -lcjson -lgsl -lgslcblas -lsundials_ida -lsundials_sunlinsolklu -lklu -lbtf -lpng -lz -lmd4c -lncursesw -ldl -lm
# The program takes these from their archives where Debian has them: each shared library that a start need not find and
# bind saves it some 60 microseconds.
ARCHIVED := gsl gslcblas sundials_ida sundials_sunlinsolklu sundials_sunmatrixsparse klu btf amd colamd suitesparseconfig png \
            z ncursesw tinfo
PROGRAM_LDLIBS := -lcjson $(foreach l,$(ARCHIVED),$(if $(wildcard /usr/lib/lib$(l).a /usr/lib/*/lib$(l).a),-l:lib$(l).a,-l$(l))) \
                  -lmd4c -ldl -lm
WRAP     := -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=free -Wl,-u,__wrap_calloc

OUT     := build/$(VARIANT)
PROGRAM := $(if $(filter release,$(VARIANT)),build/holonom,$(OUT)/holonom)

# ---- sources, found by folder ---------------------------------------------------------------------------------
CORE_LAYERS    := $(filter-out server,$(LAYERS))
SERVER_SOURCES := $(sort $(wildcard server/*.c server/*/*.c server/*/*/*.c))
MAIN_SOURCE    := server/main.c
$(foreach l,$(CORE_LAYERS),$(eval SOURCES_$(l) := $(sort $(wildcard core/$(l)/*.c core/$(l)/*/*.c))))
SOURCES_server := $(filter-out $(MAIN_SOURCE),$(SERVER_SOURCES))
SUPPORT        := $(sort $(wildcard tests/support/*.c))
HEADERS        := $(sort $(wildcard core/*/*.h core/*/*/*.h server/*.h server/*/*.h server/*/*/*.h tests/support/*.h tests/fuzz/*.h))
UNIT_SOURCES   := $(sort $(foreach l,$(LAYERS),$(wildcard tests/unit/$(l)/test_*.c)))
SLOW_SOURCES   := $(sort $(foreach l,$(LAYERS),$(wildcard tests/unit/$(l)/slow_*.c)))
BENCH_SOURCES  := $(sort $(wildcard tests/bench/bench_*.c))
EXAMPLES       := tests/library/example.c
FUZZ_SOURCES   := $(sort $(wildcard tests/fuzz/fuzz_*.c))
FUZZ_SUPPORT   := tests/fuzz/fuzz.c tests/fuzz/stand_in.c
TABLE_SOURCES  := tests/survival/survival.c tests/tables/figures.c tests/tables/accuracy.c tests/tables/tolerance.c
ALL_C          := $(foreach l,$(CORE_LAYERS),$(SOURCES_$(l))) $(SERVER_SOURCES) $(SUPPORT) \
                  $(sort $(wildcard tests/unit/*/*.c tests/bench/*.c)) $(TABLE_SOURCES) $(FUZZ_SOURCES) $(FUZZ_SUPPORT)

objects  = $(patsubst %.c,$(OUT)/%.o,$(1))
archive  = $(OUT)/lib/libhn_$(1).a
programs = $(patsubst %.c,$(OUT)/%,$(1))

LIBRARY       := $(if $(filter release,$(VARIANT)),build/libholonom.a,$(OUT)/libholonom.a)
CORE_OBJECTS  := $(foreach l,$(CORE_LAYERS),$(call objects,$(SOURCES_$(l))))
UNIT          := $(call programs,$(UNIT_SOURCES))
SLOW          := $(call programs,$(SLOW_SOURCES))
BENCH         := $(call programs,$(BENCH_SOURCES))
TABLES        := $(call programs,$(TABLE_SOURCES))
FUZZERS       := $(call programs,$(FUZZ_SOURCES))
SCRIPTS       := $(sort $(wildcard tests/house/test_* tests/library/test_* tests/scenes/test_* tests/mechanisms/test_* tests/cli/test_* tests/api/test_* tests/cluster/test_*))
BROWSER       := $(sort $(wildcard tests/browser/test_*))

# ---- building -------------------------------------------------------------------------------------------------
.PHONY: all programs
# `make` alone assumes nothing but itself, so the compilers come first
all: build/.packages-run
	@$(if $(WEB_READY),$(MAKE) -s --no-print-directory $(WEB_READY) || \
	    echo 'holonom: the libraries of the page cannot be had now; the program is built without them')
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM) $(LIBRARY)

# the HTTP library calls MHD_queue_response of the program: server/http/request/library_answer.h
$(PROGRAM): $(call objects,$(SERVER_SOURCES)) $(OUT)/generated/bundle.o $(LIBRARY)
	$(call say,link $@)
	$(Q)$(CC) $(LDFLAGS) -Wl,--export-dynamic-symbol=MHD_queue_response -o $@ $^ $(PROGRAM_LDLIBS)

# what the program reads lies in it too, so that a copy of it alone has all of it
SHIPPED = $$(find web lessons core -path '*/node_modules' -prune -o -type f \
    ! -name '*.[ch]' ! -name 'package*.json' ! -name 'README.md' ! -name '.npmrc' -print 2>/dev/null | LC_ALL=C sort)
BUNDLE := $(OUT)/generated/bundle.tar
.PHONY: bundle
bundle:
	@mkdir -p $(@D) $(dir $(BUNDLE))
	@tar --format=ustar --owner=0 --group=0 --numeric-owner --mtime=@0 --mode=644 -cf $(BUNDLE).new $(SHIPPED)
	@cmp -s $(BUNDLE).new $(BUNDLE) && rm $(BUNDLE).new || mv $(BUNDLE).new $(BUNDLE)
$(BUNDLE): bundle ;
$(OUT)/generated/bundle.o: $(BUNDLE)
	@printf '%s\n' '.section .rodata' '.globl hn_bundle_start, hn_bundle_end' 'hn_bundle_start:' '.incbin "$(BUNDLE)"' \
	    'hn_bundle_end:' '.byte 0' '.section .note.GNU-stack,"",@progbits' | $(CC) -x assembler -c -o $@ -

# style sheets of documents, as texts in C
STYLES := $(sort $(wildcard core/session/style/*.css))
$(OUT)/generated/style.c: $(STYLES)
	@mkdir -p $(@D)
	@for f in $(STYLES); do \
	    echo "extern const char hn_style_$$(basename $$f .css)[];"; echo "const char hn_style_$$(basename $$f .css)[] ="; \
	    sed -e '/^\/\*.*\*\/$$/d' -e '/^$$/d' -e 's/^ *//' -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/.*/    "&"/' $$f; \
	    echo '    "";'; done >$@
$(OUT)/generated/style.o: $(OUT)/generated/style.c
	@$(CC) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# made anew each time: an archive would keep the object of a source that is gone
$(LIBRARY): $(CORE_OBJECTS) $(OUT)/generated/style.o
	@mkdir -p $(@D)
	@rm -f $@
	@ar rcs $@ $^

define layer_rules
$(call archive,$(1)): $(call objects,$(SOURCES_$(1))) $(if $(filter session,$(1)),$(OUT)/generated/style.o)
	@mkdir -p $$(@D)
	@rm -f $$@
	@ar rcs $$@ $$^

$(OUT)/tests/unit/$(1)/%: $(OUT)/tests/unit/$(1)/%.o $(call archive,support) \
        $(call archive,$(1)) $(foreach n,$(NEEDS_$(1)),$(call archive,$(n)))
	$$(call say,link $$@)
	$$(Q)$$(CC) $$(LDFLAGS) $$(WRAP) -o $$@ -Wl,--start-group $$^ -Wl,--end-group -lcmocka $$(LDLIBS)
endef
$(foreach l,$(LAYERS),$(eval $(call layer_rules,$(l))))

$(call archive,support): $(call objects,$(SUPPORT))
	@mkdir -p $(@D)
	@rm -f $@
	@ar rcs $@ $^

$(OUT)/tests/bench/%: $(OUT)/tests/bench/%.o $(LIBRARY)
	$(call say,link $@)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(LDLIBS)

$(TABLES): %: %.o $(call archive,support) $(LIBRARY)
	$(call say,link $@)
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ -lcmocka $(LDLIBS)

# the name of a build holds the hash of its sources; the file is new only when they are
SOURCES_HASH := $(OUT)/generated/sources_hash.h
.PHONY: sources-hash
sources-hash:
	@mkdir -p $(dir $(SOURCES_HASH))
	@hash=$$(LC_ALL=C cat $(sort $(STYLES) $(wildcard core/*/*.[ch] core/*/*/*.[ch] server/*.[ch] server/*/*.[ch] server/*/*/*.[ch])) | sha256sum | cut -c 1-12); \
	    echo "#define HN_SOURCES_HASH \"$$hash\"" >$(SOURCES_HASH).new; \
	    cmp -s $(SOURCES_HASH).new $(SOURCES_HASH) && rm $(SOURCES_HASH).new || mv $(SOURCES_HASH).new $(SOURCES_HASH)
$(SOURCES_HASH): sources-hash ;
$(OUT)/server/build.o: $(SOURCES_HASH)
$(OUT)/server/build.o: CPPFLAGS += -I$(dir $(SOURCES_HASH))

# VARIANT=fuzz alone has what they need; a comparison is changed without its thread
$(FUZZERS): %: %.o $(call objects,$(FUZZ_SUPPORT)) $(call archive,server) $(LIBRARY)
	$(call say,link $@)
	$(Q)$(CC) $(LDFLAGS) -fsanitize=fuzzer $(if $(findstring fuzz_patch,$@),-Wl$(COMMA)--wrap=pthread_create$(COMMA)--wrap=pthread_detach) \
	    -o $@ $^ $(LDLIBS)

$(OUT)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(call say,compile $<)
	$(Q)$(CC) $(CFLAGS) $(CPPFLAGS) -Icore -Iserver -Itests -c -o $@ $<

$(OUT)/%.o: %.c
	@mkdir -p $(@D)
	$(call say,compile $<)
	$(Q)$(CC) $(CFLAGS) $(CPPFLAGS) -Icore $(if $(filter server/%,$<),-Iserver) -c -o $@ $<

-include $(patsubst %.c,$(OUT)/%.d,$(ALL_C))

programs: $(PROGRAM) $(UNIT) $(SLOW) $(BENCH) $(TABLES)

# ---- what a bare Debian machine lacks -------------------------------------------------------------------------
RUN_PACKAGES  := build-essential libmicrohttpd-dev libcjson-dev libgsl-dev libsundials-dev libsuitesparse-dev libosmesa6-dev libpng-dev zlib1g-dev libncurses-dev \
                 libxml2-dev libmd4c-dev ca-certificates node:nodejs npm:npm rsvg-convert:librsvg2-bin fonts-dejavu-core bwrap:bubblewrap
TEST_PACKAGES := $(RUN_PACKAGES) libcmocka-dev pkg-config:pkg-config python3-scipy python3:python3 python3-jsonschema locales chromium:chromium \
                 slurmctld slurmd slurm-client munge parallel zsh:zsh fish:fish groff:groff tmux:tmux nginx:nginx-light ncurses-term libmujoco-dev
# for make languages alone: some 700 MB
LANGUAGE_PACKAGES := $(TEST_PACKAGES) octave:octave javac:default-jdk-headless pdflatex:texlive-latex-base libeigen3-dev libejml-java python3-petsc4py \
                     python3-matplotlib
# for make notebook alone: Jupyter and its kernel, 27 MB
NOTEBOOK_PACKAGES := $(RUN_PACKAGES) jupyter-nbconvert python3-ipykernel python3-matplotlib
CHECK_PACKAGES := $(TEST_PACKAGES) clang:clang clang-format:clang-format

build/.packages-run: Makefile
	@tests/tools/packages.sh $@ $(RUN_PACKAGES)
build/.packages-test: Makefile
	@tests/tools/packages.sh $@ $(TEST_PACKAGES)
build/.packages-languages: Makefile
	@tests/tools/packages.sh $@ $(LANGUAGE_PACKAGES)
build/.packages-notebook: Makefile
	@tests/tools/packages.sh $@ $(NOTEBOOK_PACKAGES)
build/.packages-check: Makefile
	@tests/tools/packages.sh $@ $(CHECK_PACKAGES)

# the libraries of the page and of its test; `vendor` in package.json copies what the page loads
%/node_modules/.installed: %/package.json %/package-lock.json
	@echo "holonom: installing the npm packages of $*/"
	@cd $* && PUPPETEER_SKIP_DOWNLOAD=1 PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 \
	    npm ci --silent --no-audit --no-fund && npm run --silent --if-present vendor
	@touch $@

WEB_READY     := $(patsubst %/package.json,%/node_modules/.installed,$(wildcard web/package.json))
BROWSER_READY := $(patsubst %/package.json,%/node_modules/.installed,$(wildcard tests/browser/package.json))

# ---- using ----------------------------------------------------------------------------------------------------
.PHONY: run install clean help
run: all
	@build/holonom serve --port $(PORT) | while IFS= read -r line; do \
	    printf '%s\n' "$$line"; \
	    address=$$(printf '%s\n' "$$line" | sed -n 's|.*\(http://[^ ]*\).*|\1|p'); \
	    if [ -n "$$address$$opened" ] && [ -z "$$opened" ]; then \
	        opened=1; \
	        if [ -n "$$DISPLAY$$WAYLAND_DISPLAY" ] && command -v xdg-open >/dev/null 2>&1; then \
	            xdg-open "$$address" >/dev/null 2>&1 & \
	        fi; \
	    fi; \
	done

# the program, the library with its one header, and what they read: page, lessons, schema
define PKG_CONFIG
prefix=$(PREFIX)
home=$${prefix}/share/holonom

Name: holonom
Description: Mechanisms with closed kinematic loops, by many methods
Version: $(VERSION)
Cflags: -I$${prefix}/include
Libs: -L$${prefix}/lib -lholonom -pthread $(LDLIBS)
endef
export PKG_CONFIG

INSTALLED := $(DESTDIR)$(PREFIX)
install: all
	install -D -m 755 build/holonom $(INSTALLED)/bin/holonom
	install -D -m 644 build/libholonom.a $(INSTALLED)/lib/libholonom.a
	@$(CC) $(CFLAGS) -Icore -DHN_INSTALLED_HOME='"$(abspath $(PREFIX))/share/holonom"' \
	    -c -o $(OUT)/generated/installed.o core/session/model/installed.c
	@ar r $(INSTALLED)/lib/libholonom.a $(OUT)/generated/installed.o
	install -D -m 644 core/session/face/holonom.h $(INSTALLED)/include/holonom.h
	install -D -m 644 server/python/holonom.py $(INSTALLED)/share/holonom/python/holonom.py
	install -D -m 644 tests/library/example.c $(INSTALLED)/share/holonom/example.c
	@mkdir -p $(INSTALLED)/share/man/man1 $(INSTALLED)/share/bash-completion/completions \
	    $(INSTALLED)/share/zsh/site-functions $(INSTALLED)/share/fish/vendor_completions.d
	@build/holonom manual >$(INSTALLED)/share/man/man1/holonom.1
	@build/holonom completion bash >$(INSTALLED)/share/bash-completion/completions/holonom
	@build/holonom completion zsh >$(INSTALLED)/share/zsh/site-functions/_holonom
	@build/holonom completion fish >$(INSTALLED)/share/fish/vendor_completions.d/holonom.fish
	@mkdir -p $(INSTALLED)/lib/pkgconfig
	@printf '%s\n' "$$PKG_CONFIG" >$(INSTALLED)/lib/pkgconfig/holonom.pc
	@for f in $(SHIPPED); do \
	    install -D -m 644 $$f $(INSTALLED)/share/holonom/$$f || exit 1; done

clean:
	rm -rf build

help:
	@echo 'make              build build/holonom and build/libholonom.a'
	@echo 'make run          install what is missing, build, start the page (PORT=8080)'
	@echo 'make test         install what is missing, build, run the whole suite'
	@echo 'make test-quick   the unit tests alone, under 10 seconds once built'
	@echo 'make asan         the unit tests and the tests of the server under the address and undefined-behaviour sanitisers'
	@echo 'make tsan         the tests of the server under the thread sanitiser'
	@echo 'make fuzz         random bytes for everything that comes from outside: MINUTES=10 for each harness'
	@echo 'make attacks      what a hostile client does, healthz beside it: tests/tables/attacks.txt'
	@echo 'make load         300 streams, 30 browsers, 10,000 questions asked twice: a table, on a machine that does nothing else'
	@echo 'make page-damage  10,000 damaged links opened by a browser, every bad scene put into its editor: half an hour'
	@echo 'make page-speed   frames a second, first paint and bytes of the page, on a machine that does nothing else: tests/tables/page_speed.txt'
	@echo 'make compilers    the numbers of gcc and clang on every shipped scene, none may differ: tests/tables/compilers.txt'
	@echo 'make bench        time the engine beside hand-written C: tests/tables/bench.csv'
	@echo 'make bench-tui    what drawing six methods in a terminal costs: CSV on standard output'
	@echo 'make bench-peers  the same motion by MuJoCo, Simbody, SciPy, Octave: tests/tables/peers.csv and peers.svg'
	@echo 'make reference    published problems: digits that agree, printed and kept in tests/reference/results.txt'
	@echo 'make survival     the ladder of four-bars through its flat poses: which step sizes survive, kept in tests/survival/results.txt'
	@echo 'make steps        steps and evaluations of adaptive integrators beside GSL and IDA, kept in tests/reference/steps.txt'
	@echo 'make orders       orders of every formulation with every fixed-step integrator, beside theory, kept in tests/orders/results.txt'
	@echo 'make every-method every shipped scene by every method: tests/tables/every_method.csv, and a summary'
	@echo 'make sweep        every shipped scene over its sliders: no run ends without a reason; tests/tables/sweep.txt'
	@echo 'make rings        the closed ring of 3 to 100 links by every formulation: tests/tables/ring.txt'
	@echo 'make similarity   similar mechanisms of 1 nm to 1000 km by every method: tests/tables/similarity.txt'
	@echo 'make long-runs    10,000 s of a turning crank: tests/tables/long_runs.txt'
	@echo 'make mechanisms   mechanisms of textbooks against geometry and closed forms: tests/tables/mechanisms.txt'
	@echo 'make reports      which reports are right, on all scenes and 200 random mechanisms: tests/tables/reports.txt'
	@echo 'make figures      figures of hand-written programs measured again, kept in tests/tables/figures.txt'
	@echo 'make tolerance    what rtol is worth by every adaptive integrator, over all scenes: tests/tables/tolerance.txt'
	@echo 'make accuracy     error estimates of runs against their errors, over all scenes: tests/tables/accuracy.txt'
	@echo 'make references   the reference solution of every scene that has changed, for its lesson'
	@echo 'make extreme      cases in which methods break, predicted and observed: tests/tables/extreme.txt'
	@echo 'make book         all lessons for print: build/book.html and build/book.pdf'
	@echo 'make gradescope   the autograder of an exercise, build/gradescope/ID.zip: ID=gears; make prairielearn: the question'
	@echo 'make classes      1,000 formulas and 200 programs graded through kills, and every hostile program: tests/tables/classes.txt'
	@echo 'make skeletons    the slips of the usual lesson beside the exported programs: tests/tables/skeletons.txt'
	@echo 'make languages    every scene as a program in every language that Debian has: tests/tables/languages.txt'
	@echo 'make notebook     the Python notebook executed by Jupyter: build/notebook/executed.html'
	@echo 'make exercises    every exercise over 200 seeds, right answers in five spellings: tests/tables/exercises.txt'
	@echo 'make report       six scenes by twelve methods in five minutes: build/report.html, every plot in build/report/'
	@echo 'make pictures     a picture of every scene, for its lesson'
	@echo 'make check        warnings as errors (gcc, clang), layers, lone headers, format, types of the page'
	@echo 'make check-openapi the description of the API by the default rules of Redocly and Spectral'
	@echo 'make format       put every C file into the one format'
	@echo 'make install      into PREFIX=/usr/local (DESTDIR for packagers)'
	@echo 'make clean        remove build/'

# ---- testing --------------------------------------------------------------------------------------------------
.PHONY: test test-quick asan tsan fuzz load attacks page-damage page-speed compilers bench bench-tui bench-peers reference orders steps survival every-method rings sweep similarity long-runs extreme figures references report pictures exercises languages notebook skeletons classes gradescope prairielearn book run-suite run-unit run-server run-bench run-fuzz reports mechanisms accuracy tolerance
test: build/.packages-test
	@$(if $(WEB_READY)$(BROWSER_READY),$(MAKE) -s --no-print-directory $(WEB_READY) $(BROWSER_READY))
	@$(MAKE) -s $(JOBS) --no-print-directory run-suite

test-quick: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory run-unit

asan: build/.packages-test
	@$(if $(WEB_READY),$(MAKE) -s --no-print-directory $(WEB_READY))
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=asan run-unit
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=asan run-server

tsan: build/.packages-test
	@$(if $(WEB_READY),$(MAKE) -s --no-print-directory $(WEB_READY))
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=tsan run-server

# what comes from outside, with random bytes: MINUTES for each harness, HARNESS for some of them
MINUTES ?= 10
fuzz: build/.packages-check
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=release $(PROGRAM)
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=fuzz run-fuzz

# a class of 300 readers, 30 browsers, 10,000 questions asked twice with kill -9 between: four minutes, nothing else should run
load: all
	@python3 tests/load/load.py $(PROGRAM)

# each attack on a server of its own, healthz beside it: four minutes
attacks: all
	@python3 tests/load/attacks.py $(PROGRAM) >build/attacks.txt || { cat build/attacks.txt; exit 1; }
	@cp build/attacks.txt tests/tables/attacks.txt && cat tests/tables/attacks.txt

# the test of damaged links and scenes with all of them: make test takes a few
page-damage: all $(WEB_READY) $(BROWSER_READY)
	@DAMAGED_LINKS=10000 EVERY_SCENE=1 HOLONOM=$(PROGRAM) node --test tests/browser/test_damage.mjs

page-speed: all $(WEB_READY) $(BROWSER_READY)
	@mkdir -p build
	@HOLONOM=$(PROGRAM) node tests/browser/page_speed.mjs >tests/tables/page_speed.txt; status=$$?; cat tests/tables/page_speed.txt; exit $$status

bench-tui: all
	@HOLONOM=$(PROGRAM) python3 tests/bench/tui_share.py

compilers: build/.packages-check
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=clang build/clang/holonom
	@python3 tests/tables/compilers.py $(PROGRAM) build/clang/holonom >build/compilers.txt || { cat build/compilers.txt; exit 1; }
	@cp build/compilers.txt tests/tables/compilers.txt && cat tests/tables/compilers.txt

run-fuzz: $(FUZZERS)
	@python3 tests/fuzz/run.py --minutes $(MINUTES) --programs $(OUT)/tests/fuzz --work build/fuzzing \
	    $(if $(HARNESS),$(HARNESS),--table tests/tables/fuzz.txt)

bench: all
	@$(MAKE) -s $(JOBS) --no-print-directory run-bench

# other programs on the same motion: tests/bench/peers/README.md
PEER_PACKAGES := libmujoco-dev libsimbody-dev python3-scipy octave g++
PEER_LIBS     := -lsundials_nvecserial -lsundials_sunlinsoldense -lsundials_sunmatrixdense
bench-peers: all
	@dpkg -s $(PEER_PACKAGES) >/dev/null 2>&1 || { apt-get update -q && apt-get install -q -y --no-install-recommends $(PEER_PACKAGES); }
	@mkdir -p build/peers
	$(Q)$(CC) $(CFLAGS) $(CPPFLAGS) -Icore -Itests tests/bench/peers/ours.c -o build/peers/ours $(LIBRARY) $(PEER_LIBS) $(LDLIBS)
	$(Q)$(CC) $(CFLAGS) -D_DEFAULT_SOURCE tests/bench/peers/mujoco.c -o build/peers/mujoco -lmujoco -lm
	$(Q)$(CXX) -O2 -w -isystem /usr/include/simbody tests/bench/peers/simbody.cpp -o build/peers/simbody -lSimTKsimbody -lSimTKmath -lSimTKcommon
	@python3 tests/bench/peers/peers.py $(PROGRAM) build/peers

# kept only when every run was good
reference: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/reference/table.py $(PROGRAM) >build/reference.txt
	@cp build/reference.txt tests/reference/results.txt && cat tests/reference/results.txt

survival: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(TABLES)
	@$(OUT)/tests/survival/survival >build/survival.txt
	@cp build/survival.txt tests/survival/results.txt && cat tests/survival/results.txt

# fails where the best of the libraries needs fewer evaluations for the same error by more than the factor allowed
steps: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/reference/steps.py $(PROGRAM) >build/steps.txt || { cat build/steps.txt; exit 1; }
	@cp build/steps.txt tests/reference/steps.txt && cat tests/reference/steps.txt

# likewise, and every order within 0.2 of theory or with its reason
orders: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/orders/table.py $(PROGRAM) >build/orders.txt || { cat build/orders.txt; exit 1; }
	@cp build/orders.txt tests/orders/results.txt && cat tests/orders/results.txt

# ten minutes and more on one processor
every-method: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/tables/every_method.py $(PROGRAM) >build/every_method.csv
	@cp build/every_method.csv tests/tables/every_method.csv && python3 tests/tables/summary.py

# all lessons as one page for print, and as PDF
book: all build/.packages-test
	@$(MAKE) -s --no-print-directory $(WEB_READY)
	@node lessons/book.mjs $(PROGRAM) build/book.html
	@chromium --headless --no-sandbox --disable-gpu --no-pdf-header-footer --print-to-pdf=build/book.pdf "file://$(CURDIR)/build/book.html" 2>/dev/null
	@echo 'book: build/book.html, build/book.pdf'

# fails where a slip no longer does what its row says
skeletons: all build/.packages-test
	@/usr/bin/python3 tests/tables/skeletons.py $(PROGRAM) >build/skeletons.txt || { cat build/skeletons.txt; exit 1; }
	@cp build/skeletons.txt tests/tables/skeletons.txt && cat tests/tables/skeletons.txt

# what the platform is given for an exercise: ID=gears
gradescope prairielearn: all
	@python3 server/deploy/bundle.py $@ $(PROGRAM) '$(ID)' 'build/$@/$(ID)'

# some minutes on two processors; fails where a submission is lost or a file is left
classes: all build/.packages-test
	@python3 tests/tables/programs.py $(PROGRAM) >build/classes.txt; status=$$?; \
	cp build/classes.txt tests/tables/classes.txt && cat tests/tables/classes.txt; exit $$status

# half an hour on two processors; fails where a program disagrees with the workbench
PARSERS := web-tree-sitter@0.25.10 tree-sitter-julia@0.23.1
languages: build/.packages-languages
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@mkdir -p build/parsers
	@cd build/parsers && { [ -d node_modules/tree-sitter-julia ] || npm install --silent --no-audit --no-fund --no-save --ignore-scripts $(PARSERS); }
	@python3 tests/cli/test_export.py --all --parsers build/parsers/node_modules >build/languages.txt; status=$$?; \
	cp build/languages.txt tests/tables/languages.txt && cat tests/tables/languages.txt; exit $$status
	@HOLONOM=$(PROGRAM) python3 tests/cli/test_mujoco.py

# the notebook executed by Jupyter itself, in a folder of its own; fails where a cell fails or nothing is drawn
notebook: all build/.packages-notebook
	@rm -rf build/notebook && mkdir -p build/notebook
	@cp server/python/four_bar.ipynb build/notebook/
	@cd build/notebook && PATH=/usr/bin:/bin HOLONOM='$(CURDIR)/build/holonom' PYTHONPATH='$(CURDIR)/server/python' \
	    jupyter-nbconvert --to html --execute --output executed four_bar.ipynb
	@grep -q 'reduced@rk4:h=0.01 *gap' build/notebook/executed.html && test -s build/notebook/four_bar.svg
	@echo 'notebook: build/notebook/executed.html'

# some minutes on one processor; fails where a variant is bad
exercises: all
	@python3 tests/tables/exercises.py $(PROGRAM) >build/exercises.txt || { cat build/exercises.txt; exit 1; }
	@cp build/exercises.txt tests/tables/exercises.txt && cat tests/tables/exercises.txt

pictures: all
	@python3 tests/scenes/pictures.py $(PROGRAM)
	@python3 lessons/figures.py $(PROGRAM)

references: all
	@python3 tests/scenes/references.py $(PROGRAM)

# fails where a prediction is not observed; LONG=--long for the trials that take minutes
extreme: all
	@$(PROGRAM) extreme $(LONG) >build/extreme.txt || { cat build/extreme.txt; exit 1; }
	@cp build/extreme.txt tests/tables/extreme.txt && cat tests/tables/extreme.txt

# the budget leaves time for the plots and for a machine that is not alone; nothing else should run beside it
report: all
	@$(PROGRAM) report --time-limit 225 --out build/report.html --plots build/report
	@echo 'report: build/report.html, plots in build/report/'

# a quarter of an hour on two processors; fails where a run ends without a reason
sweep: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/tables/sweep.py $(PROGRAM) >build/sweep.txt; status=$$?; \
	cp build/sweep.txt tests/tables/sweep.txt && cat tests/tables/sweep.txt; exit $$status

rings: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/tables/ring.py $(PROGRAM) >build/ring.txt
	@cp build/ring.txt tests/tables/ring.txt && cat tests/tables/ring.txt

# a quarter of an hour on one processor, most of it in runs of ten million steps
similarity: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/tables/similarity.py $(PROGRAM) >build/similarity.txt && cp build/similarity.txt tests/tables/similarity.txt
	@cat tests/tables/similarity.txt

long-runs: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@python3 tests/tables/long_runs.py $(PROGRAM) >build/long_runs.txt && cp build/long_runs.txt tests/tables/long_runs.txt
	@cat tests/tables/long_runs.txt

# textbook mechanisms against facts computed without the program
mechanisms: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(PROGRAM)
	@HOLONOM=$(PROGRAM) python3 tests/mechanisms/test_mechanisms.py --table >build/mechanisms.txt && cp build/mechanisms.txt tests/tables/mechanisms.txt
	@cat tests/tables/mechanisms.txt

reports: build/.packages-test
	@python3 tests/tables/reports.py $(PROGRAM) > build/reports.txt && cp build/reports.txt tests/tables/reports.txt
	@cat tests/tables/reports.txt

figures: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(TABLES)
	@$(OUT)/tests/tables/figures >build/figures.txt || { cat build/figures.txt; exit 1; }
	@cp build/figures.txt tests/tables/figures.txt && cat tests/tables/figures.txt

accuracy: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(OUT)/tests/tables/accuracy
	@$(OUT)/tests/tables/accuracy >build/accuracy.txt || { cat build/accuracy.txt; exit 1; }
	@cp build/accuracy.txt tests/tables/accuracy.txt && cat tests/tables/accuracy.txt

# some minutes; fails where a method keeps its tolerance ten times worse than dopri5
tolerance: build/.packages-test
	@$(MAKE) -s $(JOBS) --no-print-directory $(OUT)/tests/tables/tolerance
	@$(OUT)/tests/tables/tolerance >build/tolerance.txt || { cat build/tolerance.txt; exit 1; }
	@cp build/tolerance.txt tests/tables/tolerance.txt && cat tests/tables/tolerance.txt

# HOLONOM tells the scripts which program to drive
# a locale that writes a comma in its numbers, for the tests alone
COMMA_LOCALE := build/locale/de_DE.UTF-8
$(COMMA_LOCALE):
	@mkdir -p $@
	@localedef --no-archive -i de_DE -f UTF-8 ./$@

# the longest first, so that no processor is left alone with one of them
run-suite: $(PROGRAM) $(UNIT) $(SLOW) $(COMMA_LOCALE)
	@HOLONOM=$(PROGRAM) tests/run-tests.sh $(BROWSER) $(SCRIPTS) $(SLOW) $(UNIT)

# a sanitised program takes some ten times as long; the limit is there for what hangs
SANITISED = $(if $(filter %san,$(VARIANT)),TEST_TIMEOUT=1800)

run-unit: $(UNIT) $(if $(filter asan,$(VARIANT)),$(SLOW)) $(COMMA_LOCALE)
	@$(SANITISED) LSAN_OPTIONS=suppressions=$(CURDIR)/tests/support/lsan.supp:print_suppressions=0 \
	    tests/run-tests.sh $(if $(filter asan,$(VARIANT)),$(SLOW)) $(UNIT)

# a sanitised program wants to see its whole machine: it cannot be bundled
UNSANITISED = $(if $(filter %san,$(VARIANT)),tests/cli/test_bundles.py)

run-server: $(PROGRAM)
	@$(SANITISED) HOLONOM=$(PROGRAM) TSAN_OPTIONS=halt_on_error=1:exitcode=66:suppressions=$(CURDIR)/tests/support/tsan.supp \
	    LSAN_OPTIONS=suppressions=$(CURDIR)/tests/support/lsan.supp:print_suppressions=0 \
	    tests/run-tests.sh $(filter tests/api/% tests/cli/%,$(filter-out $(UNSANITISED),$(SCRIPTS)))

run-bench: $(BENCH) $(PROGRAM)
	@for b in $(BENCH); do echo "# $$(basename $$b)"; $$b || exit 1; done >build/bench.csv
	@echo '# commands' >>build/bench.csv
	@HOLONOM=$(PROGRAM) python3 tests/bench/commands.py >>build/bench.csv
	@cp build/bench.csv tests/tables/bench.csv && cat tests/tables/bench.csv

# ---- checking -------------------------------------------------------------------------------------------------
.PHONY: check check-house test-map check-layers check-width check-functions check-contracts check-names check-circles check-licence check-openapi check-headers check-format check-web format
check: build/.packages-check check-house
	@$(MAKE) -s --no-print-directory check-headers
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=gcc programs
	@$(MAKE) -s $(JOBS) --no-print-directory VARIANT=clang programs
	@$(MAKE) -s --no-print-directory check-format
	@$(MAKE) -s --no-print-directory check-web
	@echo 'check: all good'

# what the tree promises about itself; tests/house/test_checks.sh runs it inside `make test`
check-house: check-layers check-names check-circles check-licence check-width check-functions check-contracts

# awk gets the table above as layer:need,need and layer.room:room,room
SPACE := $(subst x,,x x)
LAYER_TABLE = $(foreach l,$(LAYERS),$(l):$(subst $(SPACE),$(COMMA),$(strip $(NEEDS_$(l)))))
ROOM_TABLE  = $(foreach l,$(LAYERS),$(addprefix $(l).,$(ROOMS_$(l))))
LAYERED_C   = $(filter-out tests/%,$(ALL_C))
check-layers:
	@awk -v layers='$(LAYER_TABLE)' -v rooms='$(ROOM_TABLE)' -f tests/tools/check-layers.awk \
	    $(LAYERED_C) $(filter-out tests/%,$(HEADERS))

check-width:
	@LC_ALL=C awk -f tests/tools/check-width.awk $(ALL_C) $(EXAMPLES) $(HEADERS)

check-functions:
	@awk -f tests/tools/check-functions.awk $(LAYERED_C)

check-contracts:
	@awk -f tests/tools/check-contracts.awk $(filter-out tests/%,$(HEADERS))

check-names:
	@python3 tests/tools/check-names.py tests/tools/names.txt $(LAYERED_C) $(SUPPORT)

# read from the objects, which must be those of the sources
check-circles: $(CORE_OBJECTS) $(call objects,$(SERVER_SOURCES))
	@python3 tests/tools/check-circles.py --layers '$(LAYER_TABLE)' --rooms '$(ROOM_TABLE)' \
	    --natural tests/tools/circles.txt --out $(OUT) $^

# which unit tests call which source: SOURCE=core/linalg shows a part
test-map: $(CORE_OBJECTS) $(call objects,$(SERVER_SOURCES) $(UNIT_SOURCES))
	@python3 tests/tools/test-map.py --out $(OUT) --source '$(SOURCE)' $^

check-licence:
	@awk -f tests/tools/check-licence.awk $$(find core server web lessons tests \
	    \( -name node_modules -o -path web/vendor -o -name test-results \) -prune -o -type f \
	    \( $(foreach e,c h js mjs css py sh awk,-name '*.$e' -o) -false \) -print)

check-headers:
	@for h in $(HEADERS); do \
	    echo 'extern int not_empty;' | $(CC) $(CFLAGS) -Werror -D_DEFAULT_SOURCE -isystem /usr/include/libxml2 -Icore -Iserver -Itests \
	        -fsyntax-only -include $$h -x c - || { echo "$$h does not compile alone"; exit 1; }; done

# the page and its tests: one format, types as the comments say, no module too long
check-web: $(WEB_READY) $(BROWSER_READY)
	@npm --prefix tests/browser run --silent check

# the description of the API by the default rules of two linters: no error, no warning
OPENAPI_LINTERS := @redocly/cli@2.77.0 @stoplight/spectral-cli@6.16.3
check-openapi: all
	@mkdir -p build/openapi
	@cd build/openapi && { [ -d node_modules/@stoplight ] || npm install --silent --no-audit --no-fund --no-save $(OPENAPI_LINTERS); }
	@python3 tests/tools/openapi.py $(PROGRAM) >build/openapi/openapi.json
	@echo 'extends: ["spectral:oas"]' >build/openapi/.spectral.yaml
	@cd build/openapi && npx redocly lint --extends=recommended openapi.json >redocly.txt 2>&1; \
	    grep -q 'is valid' redocly.txt && ! grep -Eq '[0-9]+ (warning|error)' redocly.txt || { cat redocly.txt; exit 1; }
	@cd build/openapi && npx spectral lint --fail-severity=warn openapi.json && echo 'check-openapi: no error, no warning'

check-format:
	@clang-format --dry-run --Werror $(ALL_C) $(EXAMPLES) $(HEADERS)

format:
	@clang-format -i $(ALL_C) $(EXAMPLES) $(HEADERS)
