/* xml_scan.h - the tags of an XML file, one after the other, without document types. */
#ifndef FFD_BASE_TEXT_XML_SCAN_H
#define FFD_BASE_TEXT_XML_SCAN_H

#include "base/fail.h"
#include "base/text/text_scan.h"

typedef struct xml_scan {
    const char *at, *last;
    const char *file;    /* its name, for messages */
    bool takes_entities; /* entities among attributes stay as they are written; else they are refused */
} xml_scan;

/* <NAME ...>, <NAME .../> or </NAME> */
typedef struct xml_tag {
    text_word name, attributes;
    bool is_end, is_empty;
} xml_tag;

/* Moves behind the next tag, past comments and instructions. *found: false at the end of the file. Errors:
   FFD_E_INVALID for a document type, an entity among attributes that is not taken, and a tag that does not
   end. */
ffd_status ffd_xml_next(xml_scan *scan, xml_tag *tag, bool *found, ffd_error *error);
/* Finds an attribute's value. Returns false, with an empty one, if it is not there. */
bool ffd_xml_attribute(const xml_tag *tag, const char *name, text_word *value);

#endif
