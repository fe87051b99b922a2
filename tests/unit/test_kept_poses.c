/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When a map of shadow or occlusion has to be drawn again. */
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include "view/kept_poses.h"

/* Two bodies of reach 1 m, one 10 m and one 100 m before the eye, which sees a pixel of 1 mm a metre. */
static fl_frame_shape shape[3];
static int32_t row_shape[2] = {0, 1};
static fl_frame_data data;
static fl_view_pose pose[2];
static float reach[2] = {1.0f, 1.0f};
static fl_view_frame frame;
static fl_eye eye;
static fl_map_key key;
static fl_kept_poses kept;

static int set_up(void **state)
{
    fl_err err = {0};
    (void)state;
    shape[0] = shape[2] = (fl_frame_shape){.next = -1};
    shape[1] = (fl_frame_shape){.next = 2};
    shape[2].from = 9;
    data = (fl_frame_data){.shape = shape, .shapes = 3, .rows = 2, .row_shape = row_shape};
    memset(pose, 0, sizeof pose);
    pose[0].x[0] = 11.0f;
    pose[1].x[0] = 101.0f;
    pose[0].q[3] = pose[1].q[3] = 1.0f;
    frame = (fl_view_frame){.data = &data, .frame = 7, .rows = 2, .pose = pose, .reach = reach};
    memset(&eye, 0, sizeof eye);
    eye.pixel = 1e-3;
    key = (fl_map_key){1, 1, {0, 0, 0, 1}};
    return fl_kept_poses_take(&kept, &frame, &eye, &key, &err);
}

static int tear_down(void **state)
{
    (void)state;
    fl_kept_poses_free(&kept);
    return 0;
}

static int holds(double pixels) { return fl_kept_poses_hold(&kept, &frame, &eye, &key, pixels); }

static void nothing_kept_holds_nothing(void **state)
{
    (void)state;
    assert_true(holds(0.0));
    fl_kept_poses_drop(&kept);
    assert_false(holds(1e9));
}

/* The nearest point of the first body is 10 m away: 10 mm are a pixel; of the second 100 mm. */
static void a_body_may_move_by_pixels_of_its_distance(void **state)
{
    (void)state;
    pose[0].x[1] = 0.0099f;
    pose[1].x[1] = 0.0990f;
    assert_true(holds(1.0));
    pose[0].x[1] = 0.0101f;
    assert_false(holds(1.0));
    assert_true(holds(1.1));
    pose[0].x[1] = 0.0f;
    pose[1].x[1] = 0.101f;
    assert_false(holds(1.0));
    pose[1].x[1] = NAN;
    assert_false(holds(1e9));
}

/* A turn by a small angle theta moves a point at the reach, 1 m, by theta: 10 mrad are a pixel.  The
 * quaternion of the other sign is the same rotation. */
static void a_turn_moves_the_rim(void **state)
{
    (void)state;
    for (int sign = -1; sign < 2; sign += 2)
        for (int k = 0; k < 2; k++) {
            const double theta = k ? 0.0102 : 0.0098;
            pose[0].q[2] = (float)(sign * sin(0.5 * theta));
            pose[0].q[3] = (float)(sign * cos(0.5 * theta));
            assert_int_equal(holds(1.0), !k);
        }
}

static void a_body_that_comes_or_goes_counts(void **state)
{
    (void)state;
    memset(pose[1].q, 0, sizeof pose[1].q);
    assert_false(holds(1.0));
    assert_false(holds(19.0));
}

static void the_view_the_cut_and_the_shapes_count(void **state)
{
    (void)state;
    eye.both.m[3] = 1e-6f;
    assert_false(holds(1.0));
    eye.both.m[3] = 0.0f;
    key.cut[0] = 1.0f;
    assert_false(holds(1.0));
    key.cut[0] = 0.0f;
    key.ice = 0;
    assert_false(holds(1.0));
    key.ice = 1;
    assert_true(holds(0.0));
    /* the second body is cut at frame 9 */
    frame.frame = 8;
    assert_true(holds(0.0));
    frame.frame = 9;
    assert_false(holds(1.0));
    frame.frame = 7;
    frame.rows = 1;
    assert_false(holds(1.0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(nothing_kept_holds_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_body_may_move_by_pixels_of_its_distance, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_turn_moves_the_rim, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_body_that_comes_or_goes_counts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_view_the_cut_and_the_shapes_count, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
