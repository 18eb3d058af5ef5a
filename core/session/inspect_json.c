// What the compiler made of a scene: sizes, tree, loops, and the operations it kept and left out.
#include "dynamics/eval.h"
#include "session/caption.h"
#include "session/model.h"

/// A question a method asks, as the terms that answer it.
static const struct {
    const char *name;
    unsigned terms;
} QUESTIONS[] = {{"mass matrix M", HN_TERM_M},    {"forces f", HN_TERM_F},
                 {"gap phi", HN_TERM_PHI},        {"Jacobian J", HN_TERM_J},
                 {"gamma", HN_TERM_GAMMA},        {"energies", HN_TERM_ENERGY},
                 {"drawn points", HN_TERM_POINTS}};
enum { N_QUESTIONS = sizeof QUESTIONS / sizeof *QUESTIONS };
static const unsigned ALL_OF_MOTION = HN_TERM_M | HN_TERM_F | HN_TERM_J | HN_TERM_GAMMA;

static void put_sizes(hn_strbuf *b, const hn_model *model) {
    const hn_system_info info = hn_system_get_info(hn_model_system(model));
    const hn_assembly *a = hn_model_assembly(model);
    const hn_scene *scene = hn_model_scene(model);
    hn_json_key(b, "sizes");
    hn_json_object(b);
    hn_json_put_int(b, "bodies", scene->n_bodies);
    hn_json_put_int(b, "joints", scene->n_joints);
    hn_json_put_int(b, "speeds", info.nv);
    hn_json_put_int(b, "rows", info.nc);
    hn_json_put_int(b, "rank", a->rank);
    hn_json_put_int(b, "redundant", a->redundant);
    hn_json_put_int(b, "freedoms", a->freedoms);
    hn_json_put_int(b, "loops", info.n_loops);
    hn_json_put_int(b, "nodes", info.nodes);
    hn_json_put_bool(b, "depends_on_time", info.has_time);
    hn_json_put_number(b, "sigma_min", a->sigma_min);
    hn_json_put_number(b, "sigma_max", a->sigma_max);
    hn_json_end_object(b);
}

static const char *body_name(const hn_scene *scene, int body) {
    return body == HN_GROUND ? "ground" : scene->bodies[body].name;
}

/// The spanning tree: each body with the joint that carries it.
static void put_tree(hn_strbuf *b, const hn_model *model) {
    const hn_scene *scene = hn_model_scene(model);
    hn_json_key(b, "tree");
    hn_json_array(b);
    for (int i = 0; i < scene->n_bodies; i++) {
        const int joint = hn_system_tree_joint(hn_model_system(model), i);
        if (joint < 0) {
            continue;
        }
        const hn_joint *j = &scene->joints[joint];
        hn_json_object(b);
        hn_json_put_string(b, "body", scene->bodies[i].name);
        hn_json_put_string(b, "carried_by", body_name(scene, j->child == i ? j->parent : j->child));
        hn_json_put_string(b, "joint", j->name);
        hn_json_put_string(b, "type", hn_joint_type_name(j->type));
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_loops(hn_strbuf *b, const hn_model *model) {
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    hn_json_key(b, "closures");
    hn_json_array(b);
    for (int row = 0; row < info.nc; row++) {
        const int loop = hn_system_row_loop(sys, row);
        const int joint = hn_system_loop_joint(sys, loop);
        hn_json_object(b);
        hn_json_put_string(b, "row", hn_system_row_name(sys, row));
        hn_json_put_string(b, "loop", hn_system_loop_name(sys, loop));
        hn_json_put_string(b, "cut_joint",
                           joint >= 0 ? hn_model_scene(model)->joints[joint].name : NULL);
        hn_json_put_string(b, "unit", hn_system_row_is_length(sys, row) ? "m" : "1");
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_operations(hn_strbuf *b, const char *question, const hn_tape_info *t) {
    hn_json_object(b);
    hn_json_put_string(b, "question", question);
    hn_json_put_int(b, "operations", t->ops);
    hn_json_put_int(b, "add", t->add);
    hn_json_put_int(b, "mul", t->mul);
    hn_json_put_int(b, "div", t->div);
    hn_json_put_int(b, "sincos", t->sincos);
    hn_json_put_int(b, "sqrt", t->sqrt);
    hn_json_put_int(b, "other", t->other);
    hn_json_put_int(b, "instructions", t->instructions);
    hn_json_put_int(b, "slots", t->slots);
    hn_json_end_object(b);
}

/// What was counted on the way, for the list of what was left out.
typedef struct counts {
    int separate; ///< operations of M, f, J, gamma, each on its own
    int together; ///< and as one tape
    int M_kept, J_kept;
    int without_lambda, with_lambda;
} counts;

static hn_status put_terms(hn_strbuf *b, const hn_system *sys, hn_arena *arena, counts *c) {
    for (int i = 0; i <= N_QUESTIONS; i++) {
        const unsigned terms = i < N_QUESTIONS ? QUESTIONS[i].terms : ALL_OF_MOTION;
        const int *rows, *cols;
        hn_eval *eval = NULL;
        const hn_status status = hn_eval_create(sys, terms, arena, &eval);
        if (status != HN_OK) {
            return status;
        }
        const hn_tape_info tape = hn_eval_info(eval);
        put_operations(b, i < N_QUESTIONS ? QUESTIONS[i].name : "M, f, J, gamma together", &tape);
        c->separate += i < N_QUESTIONS && (terms & ALL_OF_MOTION) ? tape.ops : 0;
        c->together = tape.ops; // the last one stays
        if (terms == HN_TERM_M) {
            c->M_kept = hn_eval_pattern(eval, HN_TERM_M, &rows, &cols);
        } else if (terms == HN_TERM_J) {
            c->J_kept = hn_eval_pattern(eval, HN_TERM_J, &rows, &cols);
        }
        hn_eval_free(eval);
    }
    return HN_OK;
}

static hn_status put_accelerations(hn_strbuf *b, const hn_system *sys, hn_arena *arena, counts *c) {
    static const struct {
        const char *name;
        hn_accel_opts opts;
    } ways[] = {{"accelerations", {0, 0}},
                {"accelerations and multipliers", {0, 1}},
                {"accelerations, Baumgarte", {1, 0}}};
    for (int i = 0; i < 3; i++) {
        hn_accel *accel = NULL;
        const hn_status status = hn_accel_create(sys, &ways[i].opts, arena, &accel);
        if (status != HN_OK) {
            return status;
        }
        const hn_tape_info tape = hn_accel_tape_info(accel);
        put_operations(b, ways[i].name, &tape);
        c->without_lambda = i == 0 ? tape.ops : c->without_lambda;
        c->with_lambda = i == 1 ? tape.ops : c->with_lambda;
        hn_accel_free(accel);
    }
    return HN_OK;
}

static void put_kept(hn_strbuf *b, const char *what, int kept, int of) {
    hn_json_object(b);
    hn_json_put_string(b, "what", what);
    hn_json_put_int(b, "kept", kept);
    hn_json_put_int(b, "of", of);
    hn_json_put_int(b, "left_out", of - kept);
    hn_json_end_object(b);
}

static void put_left_out(hn_strbuf *b, const hn_system_info *info, const counts *c) {
    hn_json_key(b, "left_out");
    hn_json_array(b);
    put_kept(b, "closure rows (the rest vanish identically)", info->nc,
             info->nc + info->rows_dropped);
    put_kept(b, "entries of M, lower triangle", c->M_kept, info->nv * (info->nv + 1) / 2);
    put_kept(b, "entries of J", c->J_kept, info->nc * info->nv);
    put_kept(b, "operations of M, f, J, gamma (the rest are shared)", c->together, c->separate);
    put_kept(b, "operations when multipliers are not asked for", c->without_lambda, c->with_lambda);
    hn_json_end_array(b);
}

hn_status hn_model_inspect_json(hn_strbuf *b, const hn_model *model, hn_diags *diags) {
    const hn_system *sys = hn_model_system(model);
    const hn_system_info info = hn_system_get_info(sys);
    hn_arena *arena = hn_arena_create(0);
    counts c = {0};
    char caption[160];
    hn_model_caption(model, caption, sizeof caption);
    hn_json_object(b);
    hn_json_put_string(b, "scene", hn_model_scene(model)->id);
    hn_json_put_string(b, "title", hn_model_scene(model)->title);
    hn_json_put_string(b, "caption", caption);
    put_sizes(b, model);
    put_tree(b, model);
    put_loops(b, model);
    hn_json_key(b, "operations");
    hn_json_array(b);
    hn_status status = arena ? put_terms(b, sys, arena, &c) : HN_ERR_MEMORY;
    if (status == HN_OK) {
        status = put_accelerations(b, sys, arena, &c);
    }
    hn_json_end_array(b);
    put_left_out(b, &info, &c);
    hn_json_end_object(b);
    hn_arena_free(arena);
    return status == HN_OK
               ? HN_OK
               : hn_diags_add(diags, status, NULL, NULL, "the operations could not be counted: %s",
                              hn_status_text(status));
}
