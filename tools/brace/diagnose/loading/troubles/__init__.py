"""Troubles of the instruments: what changes the readings of a loading record, and is of no limb.

Each trouble is a set of columns beside a fitted model's readings, one column for each of its sizes. Where one is far
more likely than every set of effects, the search is done again with its columns taken out of the record
(Record.beside), so that the limb is judged by what the trouble leaves of the record.

kinds      which columns each trouble has
lag        how likely a lag is, and its sentence
steps      from which reading on a gain or a zero is another one
likeliest  the trouble that explains the record best, fitted
words      the trouble in a sentence"""
