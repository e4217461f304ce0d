# SPDX-License-Identifier: GPL-3.0-or-later
"""Names of what Blender has, as text that can be shown."""


def name_of(block, attribute='name'):
    r"""Files of old Blenders may hold names that are not UTF-8, at which RNA raises: those bytes come as \xNN."""
    try:
        return getattr(block, attribute)
    except UnicodeDecodeError as error:
        return error.object.decode(errors='backslashreplace')


def one_line(text):
    """For a report: names may have line breaks, and paths bytes that are no text. The library's messages do so, too."""
    text = ''.join(' ' if character < ' ' or character == '\x7f' else character for character in text)
    return text.encode(errors='backslashreplace').decode()
