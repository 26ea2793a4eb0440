/* The part of order.c with the refusals of paths, and the arguments of order_reflexes.h. */

static struct PathPose Path[2];
static struct FingerTouch Touch;
static struct Reflex Rule;

static void wrong_paths(void)
{
    Path[0].Kx = three(Skew);
    Path[0].Place[2] = NAN;
    Path[1].IsTip = 1;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "time of pose 0");
    Path[0].Time = Path[1].Time = 1;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "time of pose 1");
    Path[1].Time = 2;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "NaN");
    Path[0].Place[2] = 9;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "another kind");
    Path[1].IsTip = 0;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "symmetric");
    Path[0].Kx = three(Stiff);
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "bound");
    Path[0].Kx = NULL;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "limits");
    memcpy(Path[0].Place, Pos, sizeof Pos);
    memcpy(Path[1].Place, Pos, sizeof Pos);
    Path[0].Time = 0.01;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "add poses");
    Path[0].Time = 1;
    REFUSED("SendPath", SendPath(1, 2, Path, 0), "stop");
}
