// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/examples.h"

#include <stddef.h>
#include <string.h>

static const struct {
    const char *command, *lines[HN_CLI_EXAMPLES];
} EXAMPLES[] = {
    {"serve", {"serve", "serve --port 8090 --open", "serve --max-comparisons 64 --run-cpu 5"}},
    {"tui", {"tui", "tui slider-crank --set l=0.9", "tui four-bar --once --t 3.5 --size 110x32"}},
    {"list", {"list scenes", "list methods baumgarte", "list scenes --json"}},
    {"inspect", {"inspect four-bar", "inspect bennett", "inspect four-bar --set l1=0.45 --json"}},
    {"equations",
     {"equations pendulum", "equations four-bar --format latex",
      "equations slider-crank --format json"}},
    {"terms",
     {"terms four-bar", "terms four-bar --q th1=1.2 --v w1=3",
      "terms slider-crank --reactions --json"}},
    {"export",
     {"export four-bar --language python",
      "export slider-crank --language python --blanks -o slider-crank.py",
      "export four-bar --format urdf --loops loops.json -o four-bar.urdf"}},
    {"program", {"program python -o mine.py", "program c", "program octave -o mine.m"}},
    {"run",
     {"run four-bar --time 1 --plot",
      "run four-bar --method reduced@dop853:rtol=1e-10 --time 2 --every 0.1",
      "run four-bar --method projection@rk4 --at 0.5,1 --time 1 --reactions"}},
    {"compare",
     {"compare four-bar --time 2", "compare four-bar --time 5 --plot",
      "compare fb0 --methods index1@rk4:h=1e-2 ggl@radau5 --time 5 --json"}},
    {"study",
     {"study pendulum work-precision --time 1", "study four-bar budget --time 1",
      "study slider-crank stability --over h=1e-4..1e-1,c=1..1000 --grid 6x6"}},
    {"report",
     {"report four-bar --out report.html", "report four-bar slider-crank --out report.json",
      "report"}},
    {"reference",
     {"reference fb0", "reference four-bar --time 2 --json",
      "reference four-bar --time 1 --out four-bar.json"}},
    {"merge",
     {"merge part1.json part2.json", "merge part1.json part2.json --csv",
      "merge part1.json part2.json --out study.html"}},
    {"extreme", {"extreme x1", "extreme x1 x2 --csv", "extreme x1 --out extreme.html"}},
    {"snapshot",
     {"snapshot four-bar -o four-bar.png",
      "snapshot four-bar --method index1@rk4:h=2e-2 --time 2 -o torn.png",
      "snapshot four-bar --at 0,0.2,0.4 --ghosts --dimensions -o motion.svg"}},
    {"import",
     {"import mechanism.xml -o scene.json", "import robot.urdf --loops loops.json -o scene.json",
      "import mechanism.xml --json"}},
    {"lesson", {"lesson 1", "lesson 9 --json", "list lessons"}},
    {"problem", {"problem p3", "problem p1 --student s1001", "problem p1 --seeds 1..5 --check"}},
    {"rubric",
     {"rubric write p3 -o rubric.json", "rubric check rubric.json",
      "grade p3 answer.json --rubric rubric.json"}},
    {"regrade",
     {"regrade verdict.json", "regrade verdict.json answer.json", "regrade verdict.json --json"}},
    {"grade",
     {"grade p3 answer.json --format gradescope --out verdicts",
      "grade p3 handed-in --jobs 4 --out scores.csv", "grade four-bar filled-in.c"}},
    {"manual", {"manual", "manual | man -l -", "manual >holonom.1"}},
    {"completion",
     {"completion bash >~/.local/share/bash-completion/completions/holonom", "completion zsh",
      "completion fish"}},
    {"help", {"help run", "help words", "help dead point"}},
    {"version", {"version", "version --json", "--version"}},
};

const char *const *hn_examples_of(const char *command) {
    for (size_t i = 0; i < sizeof EXAMPLES / sizeof *EXAMPLES; i++) {
        if (strcmp(EXAMPLES[i].command, command) == 0) {
            return EXAMPLES[i].lines;
        }
    }
    return NULL;
}
