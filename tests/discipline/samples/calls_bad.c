/* Functions that come back to themselves, and a call through a pointer that nobody has listed. */
typedef struct {
    int (*unlisted)(int);
} door_t;

int direct(int n);
int one(int n);
int other(int n);
int through(const door_t *door, int n);
int passed(int (*step)(int), int n);
int innocent(int n);

int direct(int n) /* BAD: recursion */
{
    return n > 0 ? direct(n - 1) : 0;
}

int one(int n) /* BAD: recursion */
{
    return other(n);
}

int other(int n) /* BAD: recursion */
{
    return one(n - 1);
}

static int by_the_door(int n); /* a declaration is no function */

static const door_t door = {.unlisted = by_the_door};

int through(const door_t *at, int n) /* BAD: recursion */
{
    return at->unlisted(n); /* BAD: call through a pointer */
}

static int by_the_door(int n) /* BAD: recursion */
{
    return through(&door, n);
}

int passed(int (*step)(int), int n)
{
    return step(n); /* BAD: call through a pointer */
}

int innocent(int n)
{
    return passed(direct, n);
}
