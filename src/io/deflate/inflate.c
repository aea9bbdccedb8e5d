#include "io/deflate/inflate.h"
#include "base/system/deadline.h"
#include <string.h>
#define ZLIB_CONST /* input is not written to */
#include <zlib.h>

/* Bytes at once: zlib counts in 32 bits, and a deadline is looked at between them. */
#define AT_ONCE ((size_t)1 << 20)

static ffd_status refuse(const z_stream *stream, ffd_error *error)
{
    return ffd_fail(error, FFD_E_INVALID, "compressed data are broken: %s",
                    stream->msg ? stream->msg : "they end early");
}

/* Takes more input and room, as far as there is some. */
static void feed(z_stream *stream, size_t *input, size_t *room)
{
    const size_t taken = *input < AT_ONCE - stream->avail_in ? *input : AT_ONCE - stream->avail_in;
    const size_t given = *room < AT_ONCE - stream->avail_out ? *room : AT_ONCE - stream->avail_out;
    stream->avail_in += (uInt)taken;
    stream->avail_out += (uInt)given;
    *input -= taken;
    *room -= given;
}

/* A stream must end where the room does: one byte more is asked for. */
static ffd_status run(z_stream *stream, size_t input, size_t room, ffd_error *error)
{
    unsigned char beyond;
    bool is_beyond = false;
    for (;;) {
        TRY(ffd_deadline_check(error));
        feed(stream, &input, &room);
        if (stream->avail_out == 0 && !is_beyond) {
            is_beyond = true;
            stream->next_out = &beyond;
            stream->avail_out = 1;
        }
        const int code = inflate(stream, Z_NO_FLUSH);
        if (is_beyond && stream->avail_out == 0)
            return ffd_fail(error, FFD_E_INVALID, "compressed data are longer than what they should hold");
        if (code == Z_STREAM_END)
            return !is_beyond && (stream->avail_out > 0 || room > 0)
                       ? ffd_fail(error, FFD_E_INVALID,
                                  "compressed data are shorter than what they should hold")
                       : FFD_OK;
        if (code == Z_MEM_ERROR)
            return ffd_fail_memory(error);
        if (code != Z_OK || (stream->avail_in == 0 && input == 0 && stream->avail_out > 0))
            return refuse(stream, error);
    }
}

ffd_status ffd_inflate(const unsigned char *bytes, size_t size, bool is_raw, unsigned char *out,
                       size_t wanted, ffd_error *error)
{
    z_stream stream;
    memset(&stream, 0, sizeof stream);
    stream.next_in = bytes;
    stream.next_out = out;
    if (inflateInit2(&stream, is_raw ? -MAX_WBITS : MAX_WBITS) != Z_OK)
        return ffd_fail_memory(error);
    const ffd_status status = run(&stream, size, wanted, error);
    inflateEnd(&stream);
    return status;
}

ffd_status ffd_deflate(const unsigned char *bytes, size_t size, unsigned char *out, size_t *made,
                       ffd_error *error)
{
    z_stream stream;
    size_t input = size, room = ffd_deflate_most(size);
    ffd_status status = FFD_OK;
    int code = Z_OK;
    memset(&stream, 0, sizeof stream);
    stream.next_in = bytes;
    stream.next_out = out;
    if (deflateInit(&stream, Z_DEFAULT_COMPRESSION) != Z_OK)
        return ffd_fail_memory(error);
    while (!status && code == Z_OK) {
        status = ffd_deadline_check(error);
        feed(&stream, &input, &room);
        code = deflate(&stream, input ? Z_NO_FLUSH : Z_FINISH);
    }
    if (!status && code != Z_STREAM_END)
        status = ffd_fail(error, FFD_E_LIMIT, "zlib needs more room than it should");
    *made = (size_t)(stream.next_out - out);
    deflateEnd(&stream);
    return status;
}
