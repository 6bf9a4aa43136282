#include "cmocka_test.h"

#include <math.h>

#include "check/judge.h"

enum { PIXELS = 4 };

/* A picture that is right to the bit, in each pixel within a bound of 1e-6. */
struct picture {
    float rgb[3 * PIXELS];
    uint32_t signatures[PIXELS];
    struct reference_explanation explanations[PIXELS];
};

static struct picture right_picture(void)
{
    struct picture picture;
    for (unsigned i = 0; i < PIXELS; ++i) {
        picture.signatures[i] = i;
        picture.explanations[i] = (struct reference_explanation){
            .rgb = {0.5, 0.25, 0}, .bound = {1e-6, 1e-6, 1e-6}, .margin = INFINITY, .signature = i};
        for (unsigned c = 0; c < 3; ++c)
            picture.rgb[3 * i + c] = (float)picture.explanations[i].rgb[c];
    }
    return picture;
}

static struct judgement judge(struct picture *picture, enum status expected)
{
    const struct image image = {.width = 2, .height = 2, .rgb = picture->rgb};
    struct judgement judgement;
    assert_int_equal(judge_picture(&image, picture->signatures, picture->explanations, &judgement), expected);
    return judgement;
}

static void right(void **state)
{
    (void)state;
    struct picture picture = right_picture();
    picture.rgb[4] += 0x1p-21f; /* 4.8e-7 */
    const struct judgement judgement = judge(&picture, STATUS_DONE);
    assert_int_equal(judgement.tight, PIXELS);
    assert_true(judgement.worst_share > 0.47 && judgement.worst_share < 0.48);
    assert_int_equal(judgement.max_x, 1);
    assert_int_equal(judgement.max_y, 0);
}

/* A close decision excuses a signature, and nothing that is beyond the bound. */
static void close_decisions(void **state)
{
    (void)state;
    struct picture picture = right_picture();
    picture.explanations[3].margin = 0.5;
    picture.signatures[3] = 7;
    assert_int_equal(judge(&picture, STATUS_DONE).other_signature, 1);
    picture.rgb[9] += 0x1p-19f;
    const struct judgement judgement = judge(&picture, STATUS_DIFFERS);
    assert_int_equal(judgement.unexplained, 1);
    assert_int_equal(judgement.unexplained_x, 1);
    assert_int_equal(judgement.unexplained_y, 1);
    picture = right_picture();
    picture.signatures[0] = 7;
    assert_int_equal(judge(&picture, STATUS_DIFFERS).unexplained, 1);
}

static void wide_bounds(void **state)
{
    (void)state;
    struct picture picture = right_picture();
    picture.explanations[0].bound[2] = 0.02;
    picture.explanations[0].cause = CAUSE_HIT;
    picture.rgb[2] = 0.019f;
    picture.explanations[1].bound[0] = 1e30;
    picture.explanations[1].cause = CAUSE_UNKNOWN;
    const struct judgement judgement = judge(&picture, STATUS_DONE);
    assert_int_equal(judgement.tight, 2);
    assert_int_equal(judgement.wide[CAUSE_HIT], 1);
    assert_int_equal(judgement.wide[CAUSE_UNKNOWN], 1);
    assert_true(judgement.worst_share == 0); /* of those that are tight */
}

/* Whatever is not a number explains nothing. */
static void not_a_number(void **state)
{
    (void)state;
    struct picture picture = right_picture();
    picture.rgb[0] = NAN;
    picture.explanations[1].rgb[1] = (double)NAN;
    picture.explanations[2].bound[2] = (double)NAN;
    picture.rgb[8] = 1e-9f;
    picture.explanations[3].margin = (double)NAN;
    picture.signatures[3] = 7;
    assert_int_equal(judge(&picture, STATUS_DIFFERS).unexplained, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(right),
        cmocka_unit_test(close_decisions),
        cmocka_unit_test(wide_bounds),
        cmocka_unit_test(not_a_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
