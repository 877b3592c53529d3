"""One HTML file in which a program is looked at: `gcxform view` writes it, any browser opens it.

    reading     a program becomes moves, lines and the codes in force
    paths       columns of a toolpath as packed whole numbers
    lines       the text of a program in blocks: templates, and the numbers in them
    packing     whole numbers and bytes, deflated, one behind the other
    document    the page: our modules in `page/`, three.js in `three/`, and the data
    linking     which move of one program belongs to which of another, and how far they are apart

No line of a program is touched by Python one by one, and no byte of it is HTML: it is packed, and
the page shows it as text nodes.
"""
