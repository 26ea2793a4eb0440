/* A library with one function. If work unwinds, call releases its lock on the way. Compiled with -fexceptions, the
   frame of call therefore has a landing pad. */
void work(void);
void call(void);

static void release(int *lock)
{
    *lock = 0;
}

void call(void)
{
    int lock __attribute__((cleanup(release))) = 1;
    work();
}
