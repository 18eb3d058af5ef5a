#ifndef HN_DYNAMICS_ASSEMBLE_MODE_H
#define HN_DYNAMICS_ASSEMBLE_MODE_H
// The search for the assembly mode that a scene asks for.

#include "dynamics/assembly/assemble_state.h"

/// Goes to the assembly mode that the scene asks for, from a closed pose in s->x.
/// HN_ERR_UNREACHABLE, told, when it is not found: s->x is then as it was. HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_assemble_mode(hn_assembler *s);

#endif
