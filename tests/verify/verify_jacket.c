/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A jacket of pipes as a structure of members: statics and modes against a frame of beam elements with
 * consistent masses that is written here, and its motion in time against both (T12). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "member/member_dynamics.h"
#include "support/member_curve.h"
#include "support/verify.h"

/* --- the jacket --------------------------------------------------------------------------------- */

static const double HALF_X[] = {10, 8, 6}, HALF_Y[] = {8, 6.5, 5}, SIGN_X[] = {1, -1, -1, 1},
                    SIGN_Y[] = {1, 1, -1, -1};
static const double MODULUS = 206e9, SHEAR = 79.2e9, DENSITY = 7850.0, DECK = 100e3;

typedef struct {
    int i, j; /* 4 level + corner */
    double diameter, wall;
} pipe;

/* One diagonal a face and storey, from corner k below to k + 1 above; horizontals above. */
static int list_pipes(pipe *p)
{
    int n = 0;
    for (int l = 0; l < 2; l++)
        for (int k = 0; k < 4; k++) {
            const int next = (k + 1) % 4;
            p[n++] = (pipe){4 * l + k, 4 * (l + 1) + k, 1.2, 0.04};
            p[n++] = (pipe){4 * l + k, 4 * (l + 1) + next, 0.6, 0.02};
            p[n++] = (pipe){4 * (l + 1) + k, 4 * (l + 1) + next, 0.6, 0.02};
        }
    return n;
}

static fl_vec3 node_place(int node)
{
    const int l = node / 4, k = node % 4;
    return v3(SIGN_X[k] * HALF_X[l], SIGN_Y[k] * HALF_Y[l], 15.0 * l);
}

static void write_jacket(int pieces, double fx, double fy)
{
    pipe p[24];
    const int n = list_pipes(p);
    model_begin();
    model_line("section leg pipe 1.2 0.04 %g %g %g\nsection brace pipe 0.6 0.02 %g %g %g\n", MODULUS, SHEAR,
               DENSITY, MODULUS, SHEAR, DENSITY);
    for (int k = 0; k < 12; k++) {
        const fl_vec3 x = node_place(k);
        model_line("node n%d %g %g %g\n", k, x.x, x.y, x.z);
    }
    for (int k = 0; k < n; k++)
        model_line("member m%d n%d n%d %s %d\n", k, p[k].i, p[k].j, p[k].diameter > 1.0 ? "leg" : "brace",
                   pieces);
    for (int k = 0; k < 4; k++)
        model_line("fix n%d clamped\nmass n%d %g\nload n%d %g %g 0\n", k, 8 + k, DECK, 8 + k, fx, fy);
}

/* --- a frame of beam elements with consistent masses -------------------------------------------- */

enum { PARTS = 4, NODES = 12 + 24 * (PARTS - 1), FREE = 6 * (NODES - 4) };

static double frame_k[FREE][FREE], frame_m[FREE][FREE];

static int unknown_of(int node, int d) { return node < 4 ? -1 : 6 * (node - 4) + d; }

/* Element matrices in local axes (Przemieniecki, Theory of Matrix Structural Analysis (1968), 5.6 and
 * 11.3). */
static void element_matrices(const pipe *p, double l, double k[12][12], double m[12][12])
{
    const double in = p->diameter - 2.0 * p->wall, area = PI / 4.0 * (p->diameter * p->diameter - in * in),
                 second = PI / 64.0 * (pow(p->diameter, 4) - pow(in, 4)), mass = DENSITY * area * l,
                 ei = MODULUS * second;
    memset(k, 0, 144 * sizeof(double));
    memset(m, 0, 144 * sizeof(double));
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            const double s = a == b ? 1.0 : -1.0;
            k[6 * a][6 * b] = s * MODULUS * area / l;
            k[6 * a + 3][6 * b + 3] = s * SHEAR * 2.0 * second / l;
            m[6 * a][6 * b] = mass / (a == b ? 3.0 : 6.0);
            m[6 * a + 3][6 * b + 3] = mass * 2.0 * second / area / (a == b ? 3.0 : 6.0);
        }
    const double kb[4][4] = {{12, 6 * l, -12, 6 * l},
                             {6 * l, 4 * l * l, -6 * l, 2 * l * l},
                             {-12, -6 * l, 12, -6 * l},
                             {6 * l, 2 * l * l, -6 * l, 4 * l * l}};
    const double mb[4][4] = {{156, 22 * l, 54, -13 * l},
                             {22 * l, 4 * l * l, 13 * l, -3 * l * l},
                             {54, 13 * l, 156, -22 * l},
                             {-13 * l, -3 * l * l, -22 * l, 4 * l * l}};
    static const int in_xy[4] = {1, 5, 7, 11}, in_xz[4] = {2, 4, 8, 10}; /* deflection and slope */
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            const double turned = (r % 2 ? -1.0 : 1.0) * (c % 2 ? -1.0 : 1.0);
            k[in_xy[r]][in_xy[c]] += ei / (l * l * l) * kb[r][c];
            k[in_xz[r]][in_xz[c]] += turned * ei / (l * l * l) * kb[r][c];
            m[in_xy[r]][in_xy[c]] += mass / 420.0 * mb[r][c];
            m[in_xz[r]][in_xz[c]] += turned * mass / 420.0 * mb[r][c];
        }
}

static void add_element(const pipe *p, int i, int j, fl_vec3 xi, fl_vec3 xj)
{
    double k[12][12], m[12][12], axes[3][3];
    const fl_vec3 d = v3_sub(xj, xi), e1 = v3_unit(d), e2 = v3_normal_to(e1), e3 = v3_cross(e1, e2);
    const fl_vec3 e[3] = {e1, e2, e3};
    element_matrices(p, v3_norm(d), k, m);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) axes[r][c] = v3_at(e[r], c);
    for (int r = 0; r < 12; r++)
        for (int c = 0; c < 12; c++) {
            const int gr = unknown_of(r < 6 ? i : j, r % 6), gc = unknown_of(c < 6 ? i : j, c % 6);
            if (gr < 0 || gc < 0) continue;
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++) {
                    const double turn = axes[a][r % 3] * axes[b][c % 3];
                    frame_k[gr][gc] += turn * k[r / 3 * 3 + a][c / 3 * 3 + b];
                    frame_m[gr][gc] += turn * m[r / 3 * 3 + a][c / 3 * 3 + b];
                }
        }
}

/* K = L L^T in place. */
static void factor_frame(void)
{
    for (int j = 0; j < FREE; j++)
        for (int i = j; i < FREE; i++) {
            double sum = frame_k[i][j];
            for (int c = 0; c < j; c++) sum -= frame_k[i][c] * frame_k[j][c];
            frame_k[i][j] = i == j ? sqrt(sum) : sum / frame_k[j][j];
        }
}

static void solve_frame(double *x)
{
    for (int i = 0; i < FREE; i++) {
        for (int c = 0; c < i; c++) x[i] -= frame_k[i][c] * x[c];
        x[i] /= frame_k[i][i];
    }
    for (int i = FREE - 1; i >= 0; i--) {
        for (int c = i + 1; c < FREE; c++) x[i] -= frame_k[c][i] * x[c];
        x[i] /= frame_k[i][i];
    }
}

static void make_frame(void)
{
    pipe p[24];
    const int n = list_pipes(p);
    int next = 12;
    for (int k = 0; k < n; k++) {
        const fl_vec3 a = node_place(p[k].i), b = node_place(p[k].j);
        int last = p[k].i;
        for (int s = 1; s <= PARTS; s++) {
            const int at = s == PARTS ? p[k].j : next++;
            add_element(&p[k], last, at, v3_lerp(a, b, (s - 1.0) / PARTS), v3_lerp(a, b, (double)s / PARTS));
            last = at;
        }
    }
    for (int k = 8; k < 12; k++)
        for (int d = 0; d < 3; d++) frame_m[unknown_of(k, d)][unknown_of(k, d)] += DECK;
    factor_frame();
}

static double frame_product(const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < FREE; i++) {
        double row = 0.0;
        for (int j = 0; j < FREE; j++) row += frame_m[i][j] * b[j];
        sum += a[i] * row;
    }
    return sum;
}

/* Inverse iteration, each mode M-orthogonal to those before it. */
static void frame_modes(double *omega, int n)
{
    static double mode[4][FREE], y[FREE];
    for (int k = 0; k < n; k++) {
        double *x = mode[k], before = 0.0;
        for (int i = 0; i < FREE; i++) x[i] = sin(1.0 + i * (k + 1.0));
        for (int pass = 0; pass < 400; pass++) {
            for (int q = 0; q < k; q++) {
                const double part = frame_product(mode[q], x);
                for (int i = 0; i < FREE; i++) x[i] -= part * mode[q][i];
            }
            const double size = sqrt(frame_product(x, x));
            for (int i = 0; i < FREE; i++) x[i] /= size;
            for (int i = 0; i < FREE; i++) {
                y[i] = 0.0;
                for (int j = 0; j < FREE; j++) y[i] += frame_m[i][j] * x[j];
            }
            solve_frame(y);
            omega[k] = 1.0 / sqrt(frame_product(x, y));
            memcpy(x, y, sizeof y);
            if (fabs(omega[k] - before) < 1e-11 * omega[k]) break;
            before = omega[k];
        }
        const double size = sqrt(frame_product(x, x));
        for (int i = 0; i < FREE; i++) x[i] /= size;
    }
}

/* --- the claims -------------------------------------------------------------------------------- */

static void make_members(fl_member_model *m, fl_member_dynamics *d, int pieces, double fx, double fy,
                         double ratio)
{
    fl_member_chain unused = {0};
    fl_err err = {0};
    write_jacket(pieces, fx, fy);
    curve_chain(m, &unused, 1.0); /* reads the model */
    fl_member_chain_free(&unused);
    if (fl_member_dynamics_make(d, m, ratio, &err)) curve_fatal(&err);
}

/* A thousandth of the load, so that the second order is below the tolerance. */
static void verify_statics(void)
{
    for (int way = 0; way < 2; way++) {
        static double x[FREE];
        fl_member_model m = {0};
        fl_member_dynamics d = {0};
        memset(x, 0, sizeof x);
        for (int k = 8; k < 12; k++) x[unknown_of(k, way)] = 250.0;
        solve_frame(x);
        make_members(&m, &d, 4, way ? 0.0 : 250.0, way ? 250.0 : 0.0, 0.0);
        for (int k = 8; k < 12; k++) {
            char what[100], name[20];
            snprintf(name, sizeof name, "n%d", k);
            snprintf(what, sizeof what, "250 kN a corner along %c: corner %d [mm], beam elements", 'x' + way,
                     k - 7);
            verify_row("T12", what, 1e6 * v3_at(d.chain.ball[curve_node(&m, name)].d, way),
                       1e6 * x[unknown_of(k, way)], 2e-5, VERIFY_REL);
        }
        fl_member_dynamics_free(&d);
        fl_member_model_free(&m);
    }
}

static void verify_modes(const double *beam)
{
    static const double brief[] = {2.9367, 3.0740, 3.2058};
    fl_member_model m = {0};
    fl_member_dynamics d = {0};
    make_members(&m, &d, 16, 0.0, 0.0, 0.01);
    for (int k = 0; k < 3; k++) {
        const double f = d.modes.omega[k] / (2.0 * PI);
        char what[100];
        snprintf(what, sizeof what, "mode %d, 16 pieces a member [Hz], lumped masses", k + 1);
        verify_row("T12", what, f, brief[k], 2e-3, VERIFY_REL);
        snprintf(what, sizeof what, "mode %d [Hz], beam elements with consistent masses", k + 1);
        verify_row("T12", what, f, beam[k] / (2.0 * PI), 2e-3, VERIFY_REL);
    }
    fl_member_dynamics_free(&d);
    fl_member_model_free(&m);
}

/* Released from its deflection along x, the deck swings at the frequency of its third mode, the sway along
 * x, and what damping takes is what is missing. */
static void verify_release(const double *beam)
{
    const double ratio = 0.02;
    fl_member_model m = {0};
    fl_member_dynamics d = {0};
    make_members(&m, &d, 4, 250e3, 0.0, ratio);
    const int32_t node = curve_node(&m, "n8"), swings = verify_quick() ? 4 : 10;
    double crossing[40], before = 1.0, top = d.chain.ball[node].d.x;
    const double work =
        0.5 * 250e3 * (2.0 * d.chain.ball[node].d.x + 2.0 * d.chain.ball[curve_node(&m, "n9")].d.x);
    for (int32_t k = 0; k < d.chain.loads; k++) d.chain.load[k].force = v3(0, 0, 0);
    fl_member_dynamics_refresh(&d);
    /* Energies count from the unstrained state now. */
    d.energy_at_start = 0.0;
    const double stored = fl_member_dynamics_energy(&d);
    verify_row("T12", "strain energy of the start over half the work of the loads", stored / work, 1.0, 1e-3,
               VERIFY_REL);
    const double dt = 1e-3;
    fl_member_dynamics_set_step(&d, dt);
    int n = 0;
    double least = 0.0;
    for (int k = 1; n < 2 * swings && k < 100000; k++) {
        fl_member_dynamics_damp(&d);
        fl_member_dynamics_drift(&d);
        fl_member_dynamics_damp(&d);
        const double x = d.chain.ball[node].d.x;
        if (n >= 2 * swings - 1 && x < least) least = x;
        if ((x < 0.0) != (before < 0.0) && k > 1) crossing[n++] = dt * (k - x / (x - before));
        before = x;
    }
    const double f = 0.5 * (n - 1) / (crossing[n - 1] - crossing[0]);
    verify_row("T12", "frequency of the deck released from 250 kN a corner along x [Hz]", f,
               beam[2] / (2.0 * PI) * sqrt(1.0 - ratio * ratio), 5e-3, VERIFY_REL);
    const double all = fl_member_dynamics_energy(&d) + fl_member_dynamics_kinetic(&d);
    verify_row("T12", "energy left and taken by damping over that of the start", (all + d.damped) / stored,
               1.0, 2e-4, VERIFY_REL);
    verify_row("T12", "logarithm of the energy left, over that of the damping ratio",
               log(all / stored) / (-2.0 * ratio * beam[2] * (crossing[n - 1])), 1.0, 0.05, VERIFY_REL);
    verify_note("deck from %.4f m in substeps of %.2e s, %d a step of 1 ms", top, dt / d.substeps,
                d.substeps);
    fl_member_dynamics_free(&d);
    fl_member_model_free(&m);
}

int main(void)
{
    double beam[3];
    verify_begin("a jacket of members");
    make_frame();
    frame_modes(beam, 3);
    verify_statics();
    verify_modes(beam);
    verify_release(beam);
    return verify_end();
}
