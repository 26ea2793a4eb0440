/* The part of order.c with the refusals of paths. It also defines the arguments that order.c and its other parts pass
   to the calls for touch and reflexes. */

static struct sun2xp_path_pose Path[2];
static struct sun2xp_touch Touch;
static struct sun2xp_reflex Rule;

static void wrong_paths(void)
{
    Path[0].stiffness = three(Skew);
    Path[0].place[2] = NAN;
    Path[1].is_tip = 1;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "time of pose 0");
    Path[0].time = Path[1].time = 1;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "time of pose 1");
    Path[1].time = 2;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "NaN");
    Path[0].place[2] = 9;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "another kind");
    Path[1].is_tip = 0;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "symmetric");
    Path[0].stiffness = three(Stiff);
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "bound");
    Path[0].stiffness = NULL;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "limits");
    memcpy(Path[0].place, Pos, sizeof Pos);
    memcpy(Path[1].place, Pos, sizeof Pos);
    Path[0].time = 0.01;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "add poses");
    Path[0].time = 1;
    REFUSED("sun2xp_send_path", sun2xp_send_path(HAND, 1, 2, Path, 0), "stop");
}
