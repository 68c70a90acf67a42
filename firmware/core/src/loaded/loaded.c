#include "brace/loaded.h"

#include <float.h>
#include <math.h>

#include "base/trig.h"
#include "base/vec.h"
#include "chain/tensor.h"

/* Three Gauss points along a beam: the weight of each, its place, and how far the link has turned there for each of the
 * two curvature coordinates a and b. These are the turns at the Gauss points 1/2 -+ 1/(2 sqrt 3): the curvature is
 * linear between and beyond them. Place x: a's share is 2 int_0^x (s - xb)/(xa - xb) ds, b's likewise. */
enum { POINTS = 3 };
static const float point_weight[POINTS] = {5.0f / 18.0f, 8.0f / 18.0f, 5.0f / 18.0f};
static const float point_place[POINTS] = {0.112701665f, 0.5f, 0.887298335f};
static const float turn_by_a[POINTS] = {0.285906746f, 0.933012702f, 1.06050342f};
static const float turn_by_b[POINTS] = {-0.0605034154f, 0.0669872981f, 0.714093254f};

/* Steps of Newton's method; the last solution adds another one to the displacement. */
enum { STEPS = 2 };

/* A pivot of the stiffness matrix is 1 at no load and 0 where the load has softened the limb to nothing. On the way to
 * the equilibrium no pivot is taken smaller than this, so that a step stays bounded. */
#define LEAST_PIVOT 0.125f
#define SINGULAR_PIVOT 1e-3f
#define TURN_MOST_RAD 1.5f

#define FORCE_MOST_N 1e4f

/* The three coordinates of a link: how far its root has turned from the commanded direction, and both curvatures. */
typedef struct {
    float root, a, b;
} shape_t;

/* A symmetric matrix of a link's coordinates, and a column. */
typedef struct {
    float rr, ra, rb, aa, ab, bb;
} matrix_t;

/* A link in the femur's frame, as it is loaded in this tick. */
typedef struct {
    brace_vec_t to_beam_mm, beam_mm, root_root, end_root;
    float end_mm_per_n, bend_rad_per_n_mm;
    brace_vec_t beyond_n;   /* the force that the link's end carries: the ground's and the weights beyond */
    brace_vec_t own_n;      /* the link's own weight */
} link_t;

/* What a link tells of itself at a shape. Each part that turns by some angle has a lever r and a force F: it drives
 * that angle by r x F, and resists its turn by r . F. A spring of compliance S moves its end by S F. Its turn changes
 * that movement: it resists by less, F' S F' with F' = F turned by a quarter. This part grows with the square of the
 * load, the others with the load; the buckling factor needs them apart. */
typedef struct {
    matrix_t resists;            /* the part that grows with the load, except that of the link's end */
    float root_softens, end_softens, end_resists;
    shape_t drive;               /* what turns each coordinate, without the link's end */
    float end_drive;
    brace_vec_t tip_mm;          /* from the link's root to its end */
} link_state_t;

/* How the tip moves with each coordinate: the columns of its Jacobian, without what the link's end moves. */
typedef struct {
    brace_vec_t root, a, b, end;
    brace_vec_t root_spring, end_spring; /* springs as vectors of C */
} link_columns_t;

typedef struct {
    brace_vec_t moved_mm;
    float drive, resists, softens;
    brace_vec_t column, vector;
} spring_t;

/* A spring, turned by `turn`, under a force: iso in every direction and a vector. lever_mm: rigid part before it. */
static inline spring_t spring_at(float iso_mm_per_n, brace_vec_t root, brace_vec_t lever_mm, brace_vec_t turn,
                                 brace_vec_t force_n)
{
    const brace_vec_t v = vec_turned(root, turn), across_n = vec_quarter(force_n);
    const brace_vec_t moved = vec_plus_scaled(vec_scaled(force_n, iso_mm_per_n), v, vec_dot(v, force_n));
    const brace_vec_t aside = vec_plus_scaled(vec_scaled(across_n, iso_mm_per_n), v, vec_dot(v, across_n));
    const brace_vec_t lever = vec_plus(vec_turned(lever_mm, turn), moved);
    return (spring_t){.moved_mm = lever,
                      .drive = vec_cross(lever, force_n),
                      .resists = vec_dot(lever, force_n),
                      .softens = vec_dot(aside, across_n),
                      .column = vec_minus(vec_quarter(lever), aside),
                      .vector = v};
}

static inline brace_vec_t turn_by(float angle_rad)
{
    return (brace_vec_t){brace_cosine_coarse(angle_rad), brace_sine(angle_rad)};
}

static inline void look(const link_t *link, const shape_t *shape, link_state_t *state, link_columns_t *columns)
{
    const brace_vec_t none = {0.0f, 0.0f};
    const brace_vec_t whole_n = vec_plus(link->beyond_n, link->own_n);
    const spring_t root = spring_at(0.0f, link->root_root, link->to_beam_mm, turn_by(shape->root), whole_n);
    matrix_t m = {.rr = root.resists};
    shape_t drive = {.root = root.drive};
    brace_vec_t tip = root.moved_mm;
    *columns = (link_columns_t){.root = root.column, .root_spring = root.vector};
    for (int i = 0; i < POINTS; i++) {
        const float by_a = turn_by_a[i], by_b = turn_by_b[i];
        const brace_vec_t turn = turn_by(fmaf(by_b, shape->b, fmaf(by_a, shape->a, shape->root)));
        const brace_vec_t lever = vec_scaled(vec_turned(link->beam_mm, turn), point_weight[i]);
        const brace_vec_t force = vec_plus_scaled(link->beyond_n, link->own_n, 1.0f - point_place[i]);
        const float turned = vec_cross(lever, force), resists = vec_dot(lever, force);
        const brace_vec_t column = vec_quarter(lever);
        const float resists_a = by_a * resists, resists_b = by_b * resists;
        tip = vec_plus(tip, lever);
        drive.root += turned;
        drive.a = fmaf(by_a, turned, drive.a);
        drive.b = fmaf(by_b, turned, drive.b);
        m.rr += resists;
        m.ra += resists_a;
        m.rb += resists_b;
        m.aa = fmaf(by_a, resists_a, m.aa);
        m.ab = fmaf(by_a, resists_b, m.ab);
        m.bb = fmaf(by_b, resists_b, m.bb);
        columns->root = vec_plus(columns->root, column);
        columns->a = vec_plus_scaled(columns->a, column, by_a);
        columns->b = vec_plus_scaled(columns->b, column, by_b);
    }
    const spring_t end = spring_at(link->end_mm_per_n, link->end_root, none,
                                   turn_by(shape->root + shape->a + shape->b), link->beyond_n);
    columns->end = end.column;
    columns->end_spring = end.vector;
    *state = (link_state_t){.resists = m, .root_softens = root.softens, .end_softens = end.softens,
                            .end_resists = end.resists, .drive = drive, .end_drive = end.drive,
                            .tip_mm = vec_plus(tip, end.moved_mm)};
}

/* A link's matrix with its curvatures eliminated, first a, then b. What is left is its root. */
typedef struct {
    float pivot_a, pivot_b;
    float yields_a, yields_b;           /* compliance of each curvature, load included */
    float b_by_a, root_by_a, root_by_b; /* what eliminating one adds to another */
    float resists;                      /* of the root */
} factors_t;

/* m: of the link, with whatever resists its end already added. least: no pivot is taken smaller. */
static inline factors_t factors_of(const matrix_t *m, float bend_rad_per_n_mm, float least)
{
    factors_t f;
    f.pivot_a = fmaxf(fmaf(bend_rad_per_n_mm, m->aa, 1.0f), least);
    f.yields_a = bend_rad_per_n_mm / f.pivot_a;
    f.b_by_a = m->ab * f.yields_a;
    f.root_by_a = m->ra * f.yields_a;
    const float bb = fmaf(-m->ab, f.b_by_a, m->bb), rb = fmaf(-m->ab, f.root_by_a, m->rb);
    f.pivot_b = fmaxf(fmaf(bend_rad_per_n_mm, bb, 1.0f), least);
    f.yields_b = bend_rad_per_n_mm / f.pivot_b;
    f.root_by_b = rb * f.yields_b;
    f.resists = fmaf(-rb, f.root_by_b, fmaf(-m->ra, f.root_by_a, m->rr));
    return f;
}

/* The turn of a link's end is the sum of its coordinates, so what resists it adds to each entry. */
static inline matrix_t with_end(const matrix_t *m, float end)
{
    return (matrix_t){m->rr + end, m->ra + end, m->rb + end, m->aa + end, m->ab + end, m->bb + end};
}

static inline float end_turn(const shape_t *shape)
{
    return shape->root + shape->a + shape->b;
}

/* One link on the way in: its curvatures eliminated, and what drives each coordinate then. */
typedef struct {
    factors_t f;
    float a_driven, b_driven, driven;
} solved_t;

/* end_resists, end_drive: of all beyond the link. Newton's equations are written for the new shape itself, so what
 * resists the present shape is added to what drives it. */
static inline solved_t solve_in(const link_state_t *state, const shape_t *now, float bend_rad_per_n_mm,
                                float end_resists, float end_drive)
{
    const float own = state->end_resists - state->end_softens;
    const matrix_t *r = &state->resists;
    const float rr = r->rr - state->root_softens;
    const float drive = fmaf(own, end_turn(now), state->end_drive + end_drive);
    const matrix_t m = with_end(&(matrix_t){rr, r->ra, r->rb, r->aa, r->ab, r->bb}, own + end_resists);
    const float root = fmaf(rr, now->root, fmaf(r->ra, now->a, fmaf(r->rb, now->b, state->drive.root + drive)));
    const float a = fmaf(r->ra, now->root, fmaf(r->aa, now->a, fmaf(r->ab, now->b, state->drive.a + drive)));
    const float b = fmaf(r->rb, now->root, fmaf(r->ab, now->a, fmaf(r->bb, now->b, state->drive.b + drive)));
    solved_t s = {.f = factors_of(&m, bend_rad_per_n_mm, LEAST_PIVOT)};
    s.a_driven = a;
    s.b_driven = fmaf(-s.f.b_by_a, a, b);
    s.driven = fmaf(-s.f.root_by_b, s.b_driven, fmaf(-s.f.root_by_a, a, root));
    return s;
}

/* The way out: the shape from the turn of its root. */
static inline shape_t solve_out(const solved_t *s, float root)
{
    shape_t shape = {.root = root};
    shape.b = fmaf(s->f.yields_b, s->b_driven, -(s->f.root_by_b * root));
    shape.a = fmaf(s->f.yields_a, s->a_driven, -fmaf(s->f.root_by_a, root, s->f.b_by_a * shape.b));
    return shape;
}

typedef struct {
    link_t femur, tibia;
    link_state_t femur_state, tibia_state;
    link_columns_t femur_columns, tibia_columns;
    shape_t femur_shape, tibia_shape;
} limb_t;

static inline void look_at(limb_t *limb)
{
    look(&limb->femur, &limb->femur_shape, &limb->femur_state, &limb->femur_columns);
    look(&limb->tibia, &limb->tibia_shape, &limb->tibia_state, &limb->tibia_columns);
}

/* A step of Newton's method towards the equilibrium. */
static void step(limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm)
{
    const solved_t tibia = solve_in(&limb->tibia_state, &limb->tibia_shape, limb->tibia.bend_rad_per_n_mm, 0.0f, 0.0f);
    const float knee = 1.0f / fmaxf(fmaf(knee_rad_per_n_mm, tibia.f.resists, 1.0f), LEAST_PIVOT);
    const solved_t femur = solve_in(&limb->femur_state, &limb->femur_shape, limb->femur.bend_rad_per_n_mm,
                                    tibia.f.resists * knee, tibia.driven * knee);
    const float hip = 1.0f / fmaxf(fmaf(hip_rad_per_n_mm, femur.f.resists, 1.0f), LEAST_PIVOT);
    limb->femur_shape = solve_out(&femur, hip_rad_per_n_mm * femur.driven * hip);
    limb->tibia_shape =
        solve_out(&tibia, fmaf(knee_rad_per_n_mm, tibia.driven, end_turn(&limb->femur_shape)) * knee);
}

/* Adds to C what a link's curvatures and springs yield. beyond: the tip's movement by a turn of the link's end, of all
 * beyond it. returns the column of the root with the curvatures eliminated */
static inline brace_vec_t add_link(brace_tensor_t *c, const link_columns_t *columns, const factors_t *f,
                                   brace_vec_t beyond)
{
    const brace_vec_t end = vec_plus(columns->end, beyond);
    const brace_vec_t a = vec_plus(columns->a, end);
    const brace_vec_t b = vec_plus_scaled(vec_plus(columns->b, end), a, -f->b_by_a);
    brace_tensor_add(c, vec_scaled(a, sqrtf(f->yields_a)));
    brace_tensor_add(c, vec_scaled(b, sqrtf(f->yields_b)));
    brace_tensor_add(c, columns->root_spring);
    brace_tensor_add(c, columns->end_spring);
    return vec_plus_scaled(vec_plus_scaled(vec_plus(columns->root, end), a, -f->root_by_a), b, -f->root_by_b);
}

/* The whole matrix at the equilibrium, eliminated from the tip to the hip. */
typedef struct {
    factors_t femur, tibia;
    float hip, knee; /* pivots of the joints */
} pivots_t;

static inline matrix_t loaded_matrix(const link_state_t *state, float times, float beyond)
{
    const matrix_t *r = &state->resists;
    const float square = times * times;
    const float end = fmaf(-square, state->end_softens, fmaf(times, state->end_resists, beyond));
    return (matrix_t){fmaf(-square, state->root_softens, fmaf(times, r->rr, end)),
                      fmaf(times, r->ra, end), fmaf(times, r->rb, end),
                      fmaf(times, r->aa, end), fmaf(times, r->ab, end), fmaf(times, r->bb, end)};
}

/* times: as if the load were as many times as large */
static pivots_t pivots_at(const limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm, float times)
{
    pivots_t p;
    const matrix_t tibia = loaded_matrix(&limb->tibia_state, times, 0.0f);
    p.tibia = factors_of(&tibia, limb->tibia.bend_rad_per_n_mm, -FLT_MAX);
    p.knee = fmaf(knee_rad_per_n_mm, p.tibia.resists, 1.0f);
    const matrix_t femur = loaded_matrix(&limb->femur_state, times, p.tibia.resists / p.knee);
    p.femur = factors_of(&femur, limb->femur.bend_rad_per_n_mm, -FLT_MAX);
    p.hip = fmaf(hip_rad_per_n_mm, p.femur.resists, 1.0f);
    return p;
}

static inline bool is_stable(const pivots_t *p, float least)
{
    return p->tibia.pivot_a > least && p->tibia.pivot_b > least && p->knee > least && p->femur.pivot_a > least &&
           p->femur.pivot_b > least && p->hip > least;
}

static inline float product(const pivots_t *p)
{
    return p->tibia.pivot_a * p->tibia.pivot_b * p->knee * (p->femur.pivot_a * p->femur.pivot_b * p->hip);
}

/* The load at which the first pivot reaches zero, as a multiple of the present one. Below it all pivots are positive.
 * The search halves the logarithm's range, 1 to 2^13, and ends with a chord through the last two products. */
enum { HALVINGS = 7 };

static float buckling_factor(const limb_t *limb, float hip_rad_per_n_mm, float knee_rad_per_n_mm, float product_now)
{
    float low = 1.0f, high = 8192.0f, at_low = product_now, at_high = 0.0f, ratio = 90.5096680f;
    bool found = false;
    for (int i = 0; i < HALVINGS; i++) {
        const float middle = low * ratio;
        const pivots_t p = pivots_at(limb, hip_rad_per_n_mm, knee_rad_per_n_mm, middle);
        if (is_stable(&p, 0.0f)) {
            low = middle;
            at_low = product(&p);
        } else {
            high = middle;
            at_high = product(&p);
            found = true;
        }
        ratio = sqrtf(ratio);
    }
    if (!found) {
        return INFINITY;
    }
    const float share = at_high < 0.0f ? at_low / (at_low - at_high) : 0.5f;
    return fmaf(high - low, share, low);
}

static link_t link_seen(const brace_loaded_link_t *link, brace_vec_t direction, brace_vec_t beyond_n, brace_vec_t down)
{
    return (link_t){.to_beam_mm = vec_turned(link->to_beam_mm, direction),
                    .beam_mm = vec_turned(link->beam_mm, direction),
                    .root_root = vec_turned(link->root_root, direction),
                    .end_root = vec_turned(link->end_root, direction),
                    .end_mm_per_n = link->end_mm_per_n,
                    .bend_rad_per_n_mm = link->bend_rad_per_n_mm,
                    .beyond_n = beyond_n,
                    .own_n = vec_scaled(down, link->weight_n)};
}

static inline bool is_bent_within(const shape_t *shape)
{
    return fabsf(shape->root) <= TURN_MOST_RAD && fabsf(end_turn(shape)) <= TURN_MOST_RAD;
}

brace_status_t brace_loaded_stiffness(const brace_loaded_t *loaded, float theta1_rad, float theta2_rad,
                                      const brace_load_t *load, brace_loaded_stiffness_t *result)
{
    const float reach = fmaf(theta1_rad, theta1_rad, theta2_rad * theta2_rad);
    const float force = fabsf(load->tip.x_n) + fabsf(load->tip.z_n);
    if (!(reach <= BRACE_REACH_RAD2 && force <= FORCE_MOST_N)) {
        return reach - reach == 0.0f && force - force == 0.0f ? BRACE_E_RANGE : BRACE_E_NOT_FINITE;
    }
    const brace_vec_t forwards = {1.0f, 0.0f}, none = {0.0f, 0.0f}, femur = brace_direction(theta1_rad);
    const brace_vec_t tibia = brace_direction(-theta2_rad); /* seen from the femur */
    const brace_vec_t tip_n = vec_turned_back((brace_vec_t){load->tip.x_n, load->tip.z_n}, femur);
    const brace_vec_t down = vec_turned_back(load->down, femur);
    const float beyond_knee_n = loaded->tibia.weight_n + loaded->knee_weight_n;
    limb_t limb = {.femur = link_seen(&loaded->femur, forwards, vec_plus_scaled(tip_n, down, beyond_knee_n), down),
                   .tibia = link_seen(&loaded->tibia, tibia, tip_n, down)};
    const float base = loaded->base_rotation_rad_per_n_mm;
    look_at(&limb);
    for (int i = 0; i < STEPS; i++) {
        step(&limb, load->hip.yields_by_rad_per_n_mm + base, load->knee.yields_by_rad_per_n_mm);
        look_at(&limb);
    }

    const float hip = load->hip.slope_rad_per_n_mm + base, knee = load->knee.slope_rad_per_n_mm;
    const pivots_t p = pivots_at(&limb, hip, knee, 1.0f);
    if (!is_stable(&p, SINGULAR_PIVOT) || !is_bent_within(&limb.femur_shape) || !is_bent_within(&limb.tibia_shape)) {
        return BRACE_E_SINGULAR;
    }
    brace_tensor_t c = brace_tensor_of(loaded->base_mm_per_n + loaded->femur.end_mm_per_n + loaded->tibia.end_mm_per_n,
                                       vec_turned_back(loaded->base_root, femur));
    const brace_vec_t by_knee = add_link(&c, &limb.tibia_columns, &p.tibia, none);
    brace_tensor_add(&c, vec_scaled(by_knee, sqrtf(knee / p.knee)));
    const brace_vec_t by_hip = add_link(&c, &limb.femur_columns, &p.femur, vec_scaled(by_knee, 1.0f / p.knee));
    brace_tensor_add(&c, vec_scaled(by_hip, sqrtf(hip / p.hip)));
    brace_stiffness_t stiffness;
    const brace_status_t status = brace_tensor_inverse(&c, vec_doubled(femur), &stiffness);
    if (status != BRACE_OK) {
        return status;
    }
    const brace_vec_t straight = vec_plus(vec_plus(limb.femur.to_beam_mm, limb.femur.beam_mm),
                                          vec_plus(limb.tibia.to_beam_mm, limb.tibia.beam_mm));
    const brace_vec_t bent = vec_plus(limb.femur_state.tip_mm, limb.tibia_state.tip_mm);
    const brace_vec_t moved = vec_turned(vec_minus(bent, straight), femur);
    const float weight_n = beyond_knee_n + loaded->femur.weight_n;
    const brace_vec_t on_base = {load->tip.x_n + load->down.x * weight_n, load->tip.z_n + load->down.z * weight_n};
    const brace_vec_t base_moved = vec_plus_scaled(vec_scaled(on_base, loaded->base_mm_per_n), loaded->base_root,
                                                   vec_dot(loaded->base_root, on_base));
    result->stiffness = stiffness;
    result->displacement = (brace_displacement_t){moved.x + base_moved.x, moved.z + base_moved.z};
    result->hip_turn_rad = limb.femur_shape.root;
    result->knee_turn_rad = limb.tibia_shape.root - end_turn(&limb.femur_shape);
    result->buckling_factor = buckling_factor(&limb, hip, knee, product(&p));
    return BRACE_OK;
}
