// SPDX-License-Identifier: GPL-3.0-or-later
// The treatment of every attribute that the reader of MJCF knows. Attributes it does not know are
// named as such.
#include "import/mjcf.h"

#include <string.h>

#define USED HN_IMPORT_OUTCOME_COUNT
#define POSE "pos quat axisangle xyaxes zaxis euler"
#define END \
    { NULL, USED, NULL }

static const char LOOKS[] = "affects the appearance and editors only";
static const char SOLVER[] = "a setting of MuJoCo's solver";
static const char CONTACT[] = "contacts are not in the scene";
static const char SOFT[] = "the constraint is soft in MuJoCo and exact in the scene";

static const hn_im_rule COMPILER[] = {
    {"angle coordinate eulerseq autolimits inertiafromgeom inertiagrouprange boundmass "
     "settotalmass",
     USED, NULL},
    {"meshdir texturedir assetdir strippath discardvisual convexhull usethread fitaabb "
     "saveinertial "
     "exactmeshinertia alignfree conflict",
     HN_IMPORT_IGNORED, "about meshes, files and the compiler's own work"},
    {"fusestatic", HN_IMPORT_IGNORED, "bodies without joints stay bodies, fixed to their parents"},
    {"boundinertia", HN_IMPORT_REFUSED, "moments of inertia are kept as they are"},
    {"balanceinertia", HN_IMPORT_REFUSED,
     "an inertia that no body can have is reported as an error and not corrected"},
    END};
static const hn_im_rule OPTION[] = {
    {"gravity timestep", USED, NULL},
    {"density viscosity", HN_IMPORT_REFUSED, "the medium's drag is not in the scene"},
    {"wind", HN_IMPORT_IGNORED, "wind acts through the medium, which is not in the scene"},
    {"magnetic", HN_IMPORT_IGNORED, "only sensors feel it"},
    {"apirate impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance mpr_tolerance "
     "sleep_tolerance integrator cone jacobian solver iterations ls_iterations noslip_iterations "
     "ccd_iterations mpr_iterations sdf_iterations sdf_initpoints actuatorgroupdisable collision",
     HN_IMPORT_IGNORED, SOLVER},
    {"o_margin o_solref o_solimp o_friction", HN_IMPORT_IGNORED, CONTACT},
    END};
static const hn_im_rule FLAG[] = {
    {"gravity equality spring damper passive actuation contact limit constraint filterparent", USED,
     NULL},
    {"frictionloss", HN_IMPORT_IGNORED, "dry friction is not in the scene"},
    {"clampctrl", HN_IMPORT_IGNORED, "controls are parameters with their range"},
    {"warmstart refsafe sensor midphase nativeccd eulerdamp autoreset override energy "
     "fwdinv invdiscrete sensornoise multiccd island sleep diagexact",
     HN_IMPORT_IGNORED, SOLVER},
    END};
static const hn_im_rule BODY[] = {
    {"name childclass mocap " POSE, USED, NULL},
    {"user sleep", HN_IMPORT_IGNORED, LOOKS},
    {"gravcomp", HN_IMPORT_REFUSED, "gravity acts on the body in full"},
    END};
static const hn_im_rule FRAME[] = {{"name childclass " POSE, USED, NULL}, END};
static const hn_im_rule INERTIAL[] = {{"mass diaginertia fullinertia class " POSE, USED, NULL},
                                      END};
static const hn_im_rule JOINT[] = {
    {"name class type pos axis range limited stiffness damping springref ref", USED, NULL},
    {"group user", HN_IMPORT_IGNORED, LOOKS},
    {"solreflimit solimplimit margin solreffriction solimpfriction", HN_IMPORT_IGNORED,
     "crossing the limit is reported; no force acts there"},
    {"armature", HN_IMPORT_REFUSED, "the inertia of a rotor is not in the scene"},
    {"frictionloss", HN_IMPORT_REFUSED, "dry friction is not in the scene"},
    {"springdamper", HN_IMPORT_REFUSED,
     "stiffness and damping from time constants are not worked out: write 'stiffness' and "
     "'damping'"},
    {"actuatorfrcrange actuatorfrclimited actuatorgravcomp", HN_IMPORT_REFUSED,
     "forces of actuators are not limited at the joint"},
    END};
static const hn_im_rule FREEJOINT[] = {
    {"name", USED, NULL}, {"group user align", HN_IMPORT_IGNORED, LOOKS}, END};
static const hn_im_rule GEOM[] = {
    {"name class type size mass density fromto shellinertia group contype conaffinity " POSE, USED,
     NULL},
    {"rgba material user mesh hfield fitscale", HN_IMPORT_IGNORED, LOOKS},
    {"condim priority friction solmix solref solimp margin gap", HN_IMPORT_IGNORED, CONTACT},
    {"fluidshape fluidcoef", HN_IMPORT_IGNORED, "the medium's drag is not in the scene"},
    END};
static const hn_im_rule SITE[] = {{"name class fromto " POSE, USED, NULL},
                                  {"type size group material rgba user", HN_IMPORT_IGNORED, LOOKS},
                                  END};
static const hn_im_rule EQUALITY[] = {
    {"name class body1 body2 anchor site1 site2 active relpose joint1 joint2 polycoef", USED, NULL},
    {"solref solimp", HN_IMPORT_APPROXIMATED, SOFT},
    {"torquescale", HN_IMPORT_IGNORED, "a setting of the soft constraint"},
    END};
static const hn_im_rule ACTUATOR[] = {
    {"name class joint gear ctrllimited ctrlrange forcelimited forcerange kp kv gainprm biasprm "
     "gaintype biastype dyntype tendon site body jointinparent slidersite cranksite",
     USED, NULL},
    {"group user nsample interp delay refsite lengthrange cranklength actdim dynprm",
     HN_IMPORT_IGNORED, "not needed for a drive of a joint"},
    {"dampratio timeconst inheritrange actlimited actrange actearly damping armature",
     HN_IMPORT_REFUSED, "the drive acts without delay, and this attribute is ignored"},
    END};
static const hn_im_rule KEY[] = {
    {"name qpos qvel ctrl", USED, NULL},
    {"time", HN_IMPORT_IGNORED, "runs begin at t = 0"},
    {"act mpos mquat", HN_IMPORT_IGNORED, "the scene has nothing that these values set"},
    END};
static const hn_im_rule DEFAULT[] = {{"class", USED, NULL}, END};
static const hn_im_rule ROOT[] = {{"model", USED, NULL}, END};
static const hn_im_rule SECTION[] = {{"name", HN_IMPORT_IGNORED, LOOKS}, END};

static const struct {
    const char *elements;
    const hn_im_rule *rules;
} RULES[] = {{"mujoco", ROOT},
             {"compiler", COMPILER},
             {"option", OPTION},
             {"flag", FLAG},
             {"default", DEFAULT},
             {"body", BODY},
             {"frame", FRAME},
             {"inertial", INERTIAL},
             {"joint", JOINT},
             {"freejoint", FREEJOINT},
             {"geom", GEOM},
             {"site", SITE},
             {"connect weld equality", EQUALITY},
             {"motor position velocity general", ACTUATOR},
             {"key", KEY},
             {"worldbody actuator keyframe", SECTION}};

static const hn_im_rule *rules_of(const xmlNode *node) {
    const char *name = (const char *)node->name;
    // an equality between joints is called as a joint is
    if (strcmp(name, "joint") == 0 && hn_im_is(node->parent, "equality")) {
        return EQUALITY;
    }
    // the section, not the default of its elements
    if (strcmp(name, "equality") == 0 && !hn_im_is(node->parent, "default")) {
        return SECTION;
    }
    for (size_t i = 0; i < sizeof RULES / sizeof *RULES; i++) {
        if (hn_im_lists(RULES[i].elements, name)) {
            return RULES[i].rules;
        }
    }
    return NULL;
}

void hn_mj_check(hn_mj *m, const xmlNode *node) {
    const hn_im_rule *rules = rules_of(node);
    HN_ASSERT(rules != NULL);
    hn_im_check_attributes(m->b, node, rules);
}

void hn_mj_defaults(hn_mj *m, const xmlNode *section) {
    static const char known[] = "joint geom site equality motor position velocity general";
    hn_mj_check(m, section);
    for (const xmlNode *c = hn_im_first(section); c; c = hn_im_next(c)) {
        if (hn_im_is(c, "default")) {
            hn_mj_defaults(m, c);
        } else if (hn_im_lists(known, (const char *)c->name)) {
            hn_mj_check(m, c);
        } else {
            hn_im_skip(m->b, HN_IMPORT_IGNORED, c, "defaults of elements that are not read");
        }
    }
}
