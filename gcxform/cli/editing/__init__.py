"""`gcxform lsp`: programs and our files in an editor, as a language server.

`text` holds a document and its positions, `shop` says which pipeline it is read by, `program` reads
it and answers, `mentions` knows what lines define and name, `changes` makes edits of hints and of
text passes, `server` speaks the protocol. What answers are is decided here alone, by plain values:
only `server` knows the library of the protocol.
"""
