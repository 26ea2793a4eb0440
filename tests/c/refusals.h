/* Counts the refusals that are reported. Include sun2xp.h before this file. The code is C89. */
static int refusals;

/* The callback for sun2xp_set_log. */
static void count_refusal(int severity, const char *text, void *user)
{
    (void)text;
    (void)user;
    if (severity == SUN2XP_LOG_REFUSAL)
        refusals++;
}
