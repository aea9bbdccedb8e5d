/* config.h - nothing: without it the sources take the parts for one processor, whose files are not compiled. */
