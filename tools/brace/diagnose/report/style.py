"""The look of report.html and fleet.html: one style sheet, no fonts or files from elsewhere."""

CSS = """
:root{color-scheme:light;--ink:#22303c;--soft:#5b6b78;--line:#dfe3e7;--paper:#fff;--wash:#f5f7f8;
--effect:#c8553d;--none:#588b5b;--ambiguous:#b07d12;--unknown:#7a4fa3;--data_fault:#8a2f2f}
*{box-sizing:border-box}
body{margin:0;background:var(--wash);color:var(--ink);
font:16px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:1040px;margin:0 auto;padding:28px 20px 60px}
header,section{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:20px 26px;
margin-bottom:18px}
header{border-top:6px solid var(--accent,var(--ink))}
h1{font-size:1.05rem;margin:0 0 10px;color:var(--soft);font-weight:600}
h2{font-size:1.15rem;margin:0 0 8px}
h3{font-size:1rem;margin:18px 0 4px}
p{margin:6px 0 10px;max-width:78ch}
.lead{font-size:1.45rem;line-height:1.35;margin:4px 0 14px;max-width:60ch}
.caution{border-left:4px solid var(--soft);padding-left:10px}
.badge{display:inline-block;background:var(--accent,var(--ink));color:#fff;border-radius:99px;
padding:2px 12px;font-size:.85rem;margin-bottom:6px}
.tiles{display:flex;flex-wrap:wrap;gap:12px;margin-top:14px}
.tile{flex:1 1 190px;background:var(--wash);border-radius:8px;padding:10px 14px}
.wide-tile{flex-basis:100%}.broad-tile{flex-grow:2}
.tile i{display:block;font-style:normal;color:var(--soft);font-size:.88rem}
.tile b{overflow-wrap:anywhere;white-space:pre-line;display:block;font-size:1.3rem;line-height:1.3}
.tile>span,.small{color:var(--soft);font-size:.88rem}.tile>span{display:block;line-height:1.4}
.whole{white-space:nowrap}
table{border-collapse:collapse;width:100%;font-size:.93rem;margin:8px 0 4px}
th,td{text-align:left;padding:6px 10px 6px 0;border-bottom:1px solid var(--line);vertical-align:top}
th{color:var(--soft);font-weight:600}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums}
td.n{white-space:nowrap}
.wide{overflow-x:auto}
svg{display:block;width:100%;height:auto}
svg text{font-family:system-ui,"DejaVu Sans",sans-serif}
code,pre{font:.86rem/1.45 ui-monospace,"DejaVu Sans Mono",Menlo,monospace}
code{overflow-wrap:anywhere}
td code{overflow-wrap:normal}td code.hash{overflow-wrap:anywhere}
.small{max-width:none}
pre{background:var(--wash);border:1px solid var(--line);border-radius:8px;padding:12px 14px;overflow-x:auto;
user-select:all;-webkit-user-select:all;max-height:340px}
.class{border-left:4px solid var(--ambiguous);padding:2px 0 2px 14px;margin:10px 0}
.bar{display:inline-block;height:.7em;background:#2d6a8e;border-radius:2px;min-width:1px}
.bar.beyond{background:repeating-linear-gradient(45deg,#c8553d 0 3px,#f0c9c0 3px 6px)}.bar.floor{background:#b8c0c8}
.pics{display:grid;gap:6px 14px}.pics.of2{grid-template-columns:repeat(auto-fit,minmax(min(100%,400px),1fr))}
.pics.of1,.pics.of3{grid-template-columns:repeat(auto-fit,minmax(min(100%,280px),1fr))}
.dot{display:inline-block;width:.7em;height:.7em;border-radius:50%;background:var(--accent);margin-right:7px}
ul{margin:4px 0 10px;padding-left:22px}
a{color:#2d6a8e}
footer{color:var(--soft);font-size:.85rem;padding:4px 26px}
details summary{cursor:pointer;color:var(--soft)}
@media(max-width:600px){main{padding:10px 8px 40px}header,section{padding:14px 12px}.lead{font-size:1.15rem}
tr.head{display:none}tr{display:block;border-bottom:1px solid var(--line);padding:6px 0}
td,td.n{display:block;border:0;padding:1px 0;text-align:left;white-space:normal;overflow-wrap:anywhere}
td:empty{display:none}td[data-head]::before{content:attr(data-head) ": ";color:var(--soft)}
td code{overflow-wrap:anywhere}}
@media print{body{background:#fff}header,section{border:0;padding:8px 0;break-inside:avoid}
pre{max-height:none}}
"""
