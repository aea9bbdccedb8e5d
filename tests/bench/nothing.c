/* Does nothing but start: what of a start is the system's and the C library's, beside ffd's in bench.py. */
int main(void)
{
    return 0;
}
