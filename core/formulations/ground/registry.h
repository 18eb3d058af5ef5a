#ifndef HN_FORMULATIONS_REGISTRY_H
#define HN_FORMULATIONS_REGISTRY_H
// The formulations that exist; each is defined in its own file.
#include "formulations/ground/formulation.h"

extern const hn_formulation hn_formulation_index1, hn_formulation_baumgarte,
    hn_formulation_projection, hn_formulation_nullspace, hn_formulation_nullspace_as_printed,
    hn_formulation_partitioning, hn_formulation_reduced, hn_formulation_penalty,
    hn_formulation_augmented_lagrangian, hn_formulation_udwadia_kalaba, hn_formulation_ggl,
    hn_formulation_index2, hn_formulation_index3;
extern const hn_formulation hn_formulation_ali3p, hn_formulation_symmetric_projection,
    hn_formulation_nullspace_solver, hn_formulation_nullspace_tangent,
    hn_formulation_nullspace_untracked;

#endif
